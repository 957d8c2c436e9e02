#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/aeromap/volume_map.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// Incremented if maps of the same key get other values or another layout.
inline constexpr int map_format_version = 10;

/// A digest of everything that makes a map: scene, plane, extent, layers, models with their parameters and tables,
/// rotors, grid, version. Names of obstacles and files do not count, the contents of meshes, octrees and tables do.
[[nodiscard]] DOWNWASH_EXPORT std::string map_key(const std::vector<MapLayer>& layers, const PlaneOfMotion& plane,
                                                  const Bounds& extent);

/// The same of a volume: scene, block, and its effect.
[[nodiscard]] DOWNWASH_EXPORT std::string map_key(const VolumeMap& map);

/// Keeps what is filled of aero maps and volumes in a folder from one run to the next: of at most 32 maps, and 1 GB,
/// removing the least recently used first. Every keep() adds a file with the blocks that are new, and merges the files
/// of a map when they grow many. Nothing here throws: a file that is damaged, foreign or of another version is not
/// found, and a folder that cannot be written keeps nothing. Programs may share a folder.
class DOWNWASH_EXPORT MapCache {
 public:
    /// @param folder created with the first map
    explicit MapCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The map of these layers with all blocks that the folder has, to the last bit as they were filled; nullptr if
    /// there are none.
    [[nodiscard]] std::shared_ptr<const AeroMap> find(const std::vector<MapLayer>& layers, const PlaneOfMotion& plane,
                                                      const Bounds& extent) const noexcept;

    /// Keeps the blocks that were filled since the last call, but not those that were read; false if that is not
    /// possible.
    bool keep(const AeroMap& map) const noexcept;

    /// Adds to a volume all bricks that the folder has of it; false if there are none.
    bool read(VolumeMap& map) const noexcept;

    /// Keeps the bricks that were filled since the last call; otherwise the same.
    bool keep(const VolumeMap& map) const noexcept;

 private:
    std::filesystem::path folder_;
};

/// The map with what the cache has of it, or with nothing filled. @param folder empty: no cache
/// @throws InputError as AeroMap
[[nodiscard]] DOWNWASH_EXPORT std::shared_ptr<const AeroMap> cached_map(const std::filesystem::path& folder,
                                                                        const std::vector<MapLayer>& layers,
                                                                        const PlaneOfMotion& plane,
                                                                        const Bounds& extent);

/// Keeps what is new in a map; see MapCache. @param folder empty: nowhere
DOWNWASH_EXPORT void keep_map(const std::filesystem::path& folder, const AeroMap& map) noexcept;

}  // namespace downwash
