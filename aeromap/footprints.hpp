#pragma once

// Private to aeromap.

#include <atomic>
#include <cstddef>
#include <list>
#include <span>
#include <vector>

#include "downwash/aeromap/footprint.hpp"

namespace downwash {

/// The footprints of a scene's parts: those of primitives are made at once, those of triangles and boxes of octrees
/// when they are first asked for. Safe to share between threads.
class Footprints {
 public:
    /// @param scene must live as long as this
    explicit Footprints(const Scene& scene);
    ~Footprints();
    Footprints(const Footprints&) = delete;
    Footprints& operator=(const Footprints&) = delete;

    /// Of the scene's first parts, Scene::primitive_count() of them.
    [[nodiscard]] std::span<const Footprint> of_primitives() const noexcept { return primitives_; }

    /// Of a part that is no primitive. Kept for later while there is room, else put into `spare`.
    [[nodiscard]] const Footprint& of_other(std::size_t part, std::list<Footprint>& spare) const;

 private:
    using Kept = std::atomic<const Footprint*>;

    const Scene& scene_;
    std::vector<Footprint> primitives_;
    mutable std::vector<Kept> others_;  ///< null: not yet made
    mutable std::atomic<std::size_t> kept_{0};
};

}  // namespace downwash
