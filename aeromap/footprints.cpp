#include "downwash/aeromap/footprints.hpp"

#include <memory>

namespace downwash {
namespace {

/// About a kilobyte each.
constexpr std::size_t max_kept = 16384;

std::vector<Footprint> footprints_of_primitives(const Scene& scene) {
    std::vector<Footprint> footprints;
    footprints.reserve(scene.primitive_count());
    for (std::size_t i = 0; i < scene.primitive_count(); ++i) {
        footprints.emplace_back(scene, i);
    }
    return footprints;
}

}  // namespace

Footprints::Footprints(const Scene& scene)
    : scene_(scene),
      primitives_(footprints_of_primitives(scene)),
      others_(scene.part_count() - scene.primitive_count()) {}

Footprints::~Footprints() {
    for (Kept& kept : others_) {
        delete kept.load(std::memory_order_relaxed);
    }
}

const Footprint& Footprints::of_other(std::size_t part, std::list<Footprint>& spare) const {
    Kept& place = others_[part - primitives_.size()];
    if (const Footprint* kept = place.load(std::memory_order_acquire)) {
        return *kept;
    }
    if (kept_.load(std::memory_order_relaxed) >= max_kept) {
        return spare.emplace_back(scene_, part);
    }
    auto made = std::make_unique<const Footprint>(scene_, part);
    const Footprint* other = nullptr;
    if (!place.compare_exchange_strong(other, made.get(), std::memory_order_acq_rel)) {
        return *other;  // another thread was sooner
    }
    kept_.fetch_add(1, std::memory_order_relaxed);
    return *made.release();
}

}  // namespace downwash
