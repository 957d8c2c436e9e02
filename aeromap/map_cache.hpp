#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// Incremented if maps of the same key get other values or another layout.
inline constexpr int map_format_version = 9;

/// A digest of everything that makes a map: scene, plane, extent, layers, models with their parameters and tables,
/// rotors, grid, version. Names of obstacles and files do not count, the contents of meshes, octrees and tables do.
[[nodiscard]] DOWNWASH_EXPORT std::string map_key(const std::vector<MapLayer>& layers, const PlaneOfMotion& plane,
                                                  const Bounds& extent);

/// Keeps aero maps in a folder from one run to the next: at most 32 files and 1 GB, removing the least recently used
/// first. Nothing here throws: a file that is damaged, foreign or of another version is not found, and a folder that
/// cannot be written keeps nothing. Programs may share a folder.
class DOWNWASH_EXPORT MapCache {
 public:
    /// @param folder created with the first map
    explicit MapCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The map of these layers, to the last bit as it was built; nullptr if it is not there.
    [[nodiscard]] std::shared_ptr<const AeroMap> find(const std::vector<MapLayer>& layers, const PlaneOfMotion& plane,
                                                      const Bounds& extent) const noexcept;

    /// Keeps a map; false if that is not possible.
    bool keep(const AeroMap& map) const noexcept;

 private:
    std::filesystem::path folder_;
};

/// The map from the cache, or built and kept there. @param folder empty: no cache
/// @throws InputError, WorkStopped as AeroMap
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const AeroMap> cached_map(
    const std::filesystem::path& folder, const std::vector<MapLayer>& layers, const PlaneOfMotion& plane,
    const Bounds& extent, int threads = 1, const std::function<void(double)>& on_progress = {},
    const StopCondition& is_over = {});

}  // namespace downwash
