#include "downwash/aeromap/volume_bricks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"

namespace downwash {
namespace {

/// Adds the time from its making to its end to a sum.
class TimeSpent {
 public:
    explicit TimeSpent(std::atomic<std::int64_t>& sum_ns) : sum_ns_(sum_ns) {}
    ~TimeSpent() { sum_ns_ += std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin_).count(); }
    TimeSpent(const TimeSpent&) = delete;
    TimeSpent& operator=(const TimeSpent&) = delete;

 private:
    using Clock = std::chrono::steady_clock;
    std::atomic<std::int64_t>& sum_ns_;
    Clock::time_point begin_ = Clock::now();
};

constexpr double longest_radii = 0.45;  // of a cell's edge: no obstacle is missed

void require_range(double low_m, double high_m, const char* axis) {
    if (!(std::isfinite(low_m) && std::isfinite(high_m) && low_m < high_m)) {
        throw_input_error(std::string("the volume's ") + axis + " must be two finite numbers, the lower one first");
    }
}

VolumeGrid grid_over(const PlaneOfMotion& frame, const Bounds& extent, double lateral_low_m, double lateral_high_m,
                     double radius_m) {
    require_range(extent.x_low_m, extent.x_high_m, "x");
    require_range(lateral_low_m, lateral_high_m, "lateral");
    require_range(extent.z_low_m, extent.z_high_m, "z");
    VolumeGrid grid{frame,
                    {extent.x_low_m, lateral_low_m, extent.z_low_m},
                    {extent.x_high_m, lateral_high_m, extent.z_high_m},
                    {},
                    {},
                    {}};
    std::array<double, 3> cells{};
    double bricks = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length_m = grid.high_m[axis] - grid.low_m[axis];
        cells[axis] = std::max(1.0, std::ceil(length_m / (longest_radii * radius_m)));
        grid.cell_m[axis] = length_m / cells[axis];
        bricks *= std::ceil(cells[axis] / VolumeBrick::side_cells);
    }
    if (!(bricks <= static_cast<double>(max_volume_bricks))) {
        throw_input_error("the volume has more than 2^22 bricks of 1.8 rotor radii; choose a smaller one");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.cells[axis] = static_cast<std::uint32_t>(cells[axis]);
        grid.bricks[axis] = (grid.cells[axis] + VolumeBrick::side_cells - 1) / VolumeBrick::side_cells;
    }
    return grid;
}

/// Nothing near anywhere: the flyable area's end is at least R away.
std::unique_ptr<const VolumeBrick> calm_brick(double radius_m) {
    auto brick = std::make_unique<VolumeBrick>();
    for (VolumeNode& cell : brick->cells) {
        cell = {VolumeNodeKind::calm, static_cast<float>(radius_m), nullptr, nullptr};
    }
    return brick;
}

/// Gives a node and what is below it the content of another one where it has none.
void adopt(VolumeNode& node, const VolumeNode& theirs, OwnedBrick& brick) {
    if (theirs.kind == VolumeNodeKind::unknown) {
        return;
    }
    const bool was_unknown = node.kind == VolumeNodeKind::unknown;
    VolumeNode content = was_unknown ? theirs : node;
    if (was_unknown && theirs.polynomials != nullptr) {
        content.polynomials = theirs.kind == VolumeNodeKind::both
                                  ? brick.keep(theirs.polynomials[0], theirs.polynomials[1])
                                  : brick.keep(theirs.polynomials[0]);
    }
    if (is_halving(theirs.kind)) {
        if (node.kind != theirs.kind && !was_unknown) {
            return;
        }
        content.halves = was_unknown ? brick.new_halves() : node.halves;
        for (const std::size_t which : {0U, 1U}) {
            adopt(content.halves[which], theirs.halves[which], brick);
        }
    }
    if (was_unknown) {
        brick.publish(node, content);
    }
}

}  // namespace

SidedFactor<double> direct_value(const DirectEffect& effect, const Vector3& hub_m) {
    if (effect.is_of_walls_around()) {
        const Vector3 towards = effect.towards_wall(hub_m);
        return {towards[0], towards[1]};
    }
    return is_finite(hub_m) ? effect.sided_factor(hub_m) : SidedFactor<double>{1, 1};
}

VolumeBricks::VolumeBricks(std::shared_ptr<const DirectEffect> effect, const PlaneOfMotion& frame, const Bounds& extent,
                           double lateral_low_m, double lateral_high_m)
    : effect_(std::move(effect)),
      grid_(grid_over(frame, extent, lateral_low_m, lateral_high_m, effect_->rotor_radius_m())),
      calm_(calm_brick(effect_->rotor_radius_m())),
      places_(grid_.brick_count(), nullptr),
      owners_(places_.size()),
      is_new_(places_.size(), 0) {}

VolumeView VolumeBricks::view() noexcept {
    VolumeView view{};
    view.cos_heading = grid_.frame.cos_heading();
    view.sin_heading = grid_.frame.sin_heading();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        view.origin_m[axis] = grid_.frame.origin_m()[axis];
        view.low_m[axis] = grid_.low_m[axis];
        view.cells_per_m[axis] = grid_.cells[axis] / (grid_.high_m[axis] - grid_.low_m[axis]);
        view.cells[axis] = grid_.cells[axis];
    }
    view.bricks[0] = grid_.bricks[0];
    view.bricks[1] = grid_.bricks[1];
    view.calm_value = effect_->is_of_walls_around() ? 0 : 1;
    view.places = places_.data();
    view.source = this;
    return view;
}

void VolumeBricks::put(std::size_t number, std::unique_ptr<OwnedBrick> brick) {
    const std::scoped_lock lock(mutex_);
    if (places_[number] == nullptr) {
        owners_[number] = std::move(brick);
        const VolumeBrick* const place = owners_[number] != nullptr ? owners_[number].get() : calm_.get();
        __atomic_store_n(&places_[number], place, __ATOMIC_RELEASE);
    }
}

const VolumeBrick& VolumeBricks::made(std::size_t number) {
    const VolumeBrick* place = __atomic_load_n(&places_[number], __ATOMIC_ACQUIRE);
    if (place == nullptr) {
        const TimeSpent spent(filling_ns_);
        put(number, make_brick(*effect_, grid_, number));
        note_explored(number);
        place = __atomic_load_n(&places_[number], __ATOMIC_ACQUIRE);
    }
    return *place;
}

void VolumeBricks::explore(const PlaceInBrick& place) {
    OwnedBrick& brick = *owners_[place.brick];
    {
        const std::scoped_lock lock(brick.mutex);
        const TimeSpent spent(filling_ns_);
        downwash::explore(*effect_, grid_, place, brick);
    }
    note_explored(place.brick);
}

/// Lets bricks forget their samples that nobody has asked lately.
void VolumeBricks::note_explored(std::size_t number) {
    constexpr std::size_t max_lately = 64;
    OwnedBrick* forgets = nullptr;
    {
        const std::scoped_lock lock(mutex_);
        is_new_[number] = 1;
        if (owners_[number] != nullptr && std::find(lately_.begin(), lately_.end(), number) == lately_.end()) {
            lately_.push_back(number);
        }
        if (lately_.size() > max_lately) {
            forgets = owners_[lately_.front()].get();
            lately_.pop_front();
        }
    }
    if (forgets != nullptr) {
        const std::scoped_lock lock(forgets->mutex);
        forgets->samples = {};
    }
}

void VolumeBricks::fill(int threads, const std::function<void(double)>& on_progress, const StopCondition& is_over) {
    throw_if_over(is_over);
    run_parallel(
        places_.size(), threads,
        [&](std::size_t number) {
            throw_if_over(is_over);
            static_cast<void>(made(number));
            if (owners_[number] != nullptr) {
                {
                    const std::scoped_lock lock(owners_[number]->mutex);
                    const TimeSpent spent(filling_ns_);
                    explore_all(*effect_, grid_, number, *owners_[number]);
                    owners_[number]->samples = {};
                }
                note_explored(number);
            }
        },
        on_progress);
}

std::vector<std::size_t> VolumeBricks::made() const {
    const std::scoped_lock lock(mutex_);
    std::vector<std::size_t> numbers;
    for (std::size_t number = 0; number < places_.size(); ++number) {
        if (places_[number] != nullptr) {
            numbers.push_back(number);
        }
    }
    return numbers;
}

std::vector<std::size_t> VolumeBricks::take_new() {
    const std::scoped_lock lock(mutex_);
    std::vector<std::size_t> numbers;
    for (std::size_t number = 0; number < places_.size(); ++number) {
        if (std::exchange(is_new_[number], std::uint8_t{0}) != 0) {
            numbers.push_back(number);
        }
    }
    return numbers;
}

bool VolumeBricks::is_calm(std::size_t number) const {
    return __atomic_load_n(&places_[number], __ATOMIC_ACQUIRE) == calm_.get();
}

void VolumeBricks::adopt(std::size_t number, std::unique_ptr<OwnedBrick> brick) {
    if (__atomic_load_n(&places_[number], __ATOMIC_ACQUIRE) == nullptr) {
        if (brick != nullptr) {  // what is the same in the whole brick is not in its bytes
            std::unique_ptr<OwnedBrick> blank = make_brick(*effect_, grid_, number);
            if (blank == nullptr) {
                return;
            }
            put(number, std::move(blank));
        } else {
            put(number, nullptr);
        }
    }
    if (brick != nullptr && !is_calm(number)) {
        OwnedBrick& ours = *owners_[number];
        const std::scoped_lock lock(ours.mutex);
        for (std::size_t cell = 0; cell < VolumeBrick::cell_count; ++cell) {
            downwash::adopt(ours.cells[cell], brick->cells[cell], ours);
        }
    }
}

template <class Each>
void VolumeBricks::for_each_owned(const Each& each) const {
    for (const std::size_t number : made()) {
        if (!is_calm(number)) {
            const std::scoped_lock lock(owners_[number]->mutex);
            each(*owners_[number]);
        }
    }
}

std::size_t VolumeBricks::polynomials() const {
    std::size_t count = 0;
    for_each_owned([&](const OwnedBrick& brick) { count += brick.polynomials(); });
    return count;
}

std::size_t VolumeBricks::memory_bytes() const {
    // Pointers to a brick and to its owner, and a flag, whether there is one or not.
    std::size_t bytes = sizeof(*this) + sizeof(VolumeBrick) + places_.size() * (2 * sizeof(void*) + 1);
    for_each_owned([&](const OwnedBrick& brick) { bytes += brick.memory_bytes(); });
    return bytes;
}

const VolumeBrick& made_brick(const VolumeView& view, std::size_t number) {
    return view.source->made(number);
}

void explore(const VolumeView& view, const PlaceInBrick& place) {
    view.source->explore(place);
}

SidedFactor<double> direct_value(const VolumeView& view, double x_m, double y_m, double z_m) {
    return direct_value(*view.source->effect(), {x_m, y_m, z_m});
}

}  // namespace downwash
