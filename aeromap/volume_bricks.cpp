#include "downwash/aeromap/volume_bricks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <new>
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

void require_range(double low_m, double high_m, const char* axis) {
    if (!(std::isfinite(low_m) && std::isfinite(high_m) && low_m < high_m)) {
        throw_input_error(std::string("the volume's ") + axis + " must be two finite numbers, the lower one first");
    }
}

double cells_along(double length_m, double radius_m) {
    return std::max(1.0, std::ceil(length_m / (longest_cell_radii * radius_m)));
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
    if (!has_few_bricks(extent, lateral_low_m, lateral_high_m, radius_m)) {
        throw_input_error("the volume has more than 2^26 bricks of 1.8 rotor radii; choose a smaller one");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length_m = grid.high_m[axis] - grid.low_m[axis];
        const double cells = cells_along(length_m, radius_m);
        grid.cell_m[axis] = length_m / cells;
        grid.cells[axis] = static_cast<std::uint32_t>(cells);
        grid.bricks[axis] = (grid.cells[axis] + VolumeBrick::side_cells - 1) / VolumeBrick::side_cells;
    }
    return grid;
}

/// Null pointers, which become memory page by page where they are written to: no container does that.
VolumeBrick** null_places(std::size_t count) {
    // NOLINTNEXTLINE(cppcoreguidelines-no-malloc)
    void* const places = std::calloc(count, sizeof(void*));
    if (places == nullptr) {
        throw std::bad_alloc();
    }
    return static_cast<VolumeBrick**>(places);
}

/// Nothing near anywhere: the flyable area's end is at least R away.
std::unique_ptr<VolumeBrick> calm_brick(double radius_m) {
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

bool has_few_bricks(const Bounds& extent, double lateral_low_m, double lateral_high_m, double radius_m) {
    double bricks = 1;
    for (const double length_m :
         {extent.x_high_m - extent.x_low_m, lateral_high_m - lateral_low_m, extent.z_high_m - extent.z_low_m}) {
        bricks *= std::ceil(cells_along(length_m, radius_m) / VolumeBrick::side_cells);
    }
    return bricks <= static_cast<double>(max_volume_bricks);
}

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
      places_(null_places(grid_.brick_count())) {}

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
    view.places = places_.get();
    view.source = this;
    return view;
}

VolumeBrick* VolumeBricks::place(std::size_t number) const noexcept {
    return __atomic_load_n(&places_[number], __ATOMIC_ACQUIRE);
}

void VolumeBricks::put(std::size_t number, std::unique_ptr<OwnedBrick> brick) {
    const std::scoped_lock lock(mutex_);
    if (places_[number] == nullptr) {
        made_.push_back(number);
        VolumeBrick* one = calm_.get();
        if (brick != nullptr) {
            one = brick.get();
            owned_.push_back(std::move(brick));
        }
        __atomic_store_n(&places_[number], one, __ATOMIC_RELEASE);
    }
}

const VolumeBrick& VolumeBricks::made(std::size_t number) {
    if (place(number) == nullptr) {
        const TimeSpent spent(filling_ns_);
        put(number, make_brick(*effect_, grid_, number));
        note_explored(number);
    }
    return *place(number);
}

OwnedBrick* VolumeBricks::owned(std::size_t number) const {
    VolumeBrick* const brick = place(number);
    return brick == calm_.get() ? nullptr : static_cast<OwnedBrick*>(brick);
}

void VolumeBricks::explore(const PlaceInBrick& place) {
    OwnedBrick& brick = *owned(place.brick);
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
    OwnedBrick* const brick = owned(number);
    OwnedBrick* forgets = nullptr;
    {
        const std::scoped_lock lock(mutex_);
        new_.insert(number);
        if (brick != nullptr && std::find(lately_.begin(), lately_.end(), brick) == lately_.end()) {
            lately_.push_back(brick);
        }
        if (lately_.size() > max_lately) {
            forgets = lately_.front();
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
        grid_.brick_count(), threads,
        [&](std::size_t number) {
            throw_if_over(is_over);
            static_cast<void>(made(number));
            if (OwnedBrick* const brick = owned(number); brick != nullptr) {
                {
                    const std::scoped_lock lock(brick->mutex);
                    const TimeSpent spent(filling_ns_);
                    explore_all(*effect_, grid_, number, *brick);
                    brick->samples = {};
                }
                note_explored(number);
            }
        },
        on_progress);
}

std::vector<std::size_t> VolumeBricks::made() const {
    const std::scoped_lock lock(mutex_);
    std::vector<std::size_t> numbers = made_;
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

std::vector<std::size_t> VolumeBricks::take_new() {
    const std::scoped_lock lock(mutex_);
    std::vector<std::size_t> numbers(new_.begin(), new_.end());
    new_.clear();
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

void VolumeBricks::adopt(std::size_t number, std::unique_ptr<OwnedBrick> brick) {
    if (place(number) == nullptr) {
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
    if (OwnedBrick* const ours = owned(number); brick != nullptr && ours != nullptr) {
        const std::scoped_lock lock(ours->mutex);
        for (std::size_t cell = 0; cell < VolumeBrick::cell_count; ++cell) {
            downwash::adopt(ours->cells[cell], brick->cells[cell], *ours);
        }
    }
}

template <class Each>
void VolumeBricks::for_each_owned(const Each& each) const {
    const std::scoped_lock lock(mutex_);
    for (const std::unique_ptr<OwnedBrick>& brick : owned_) {
        const std::scoped_lock brick_lock(brick->mutex);
        each(*brick);
    }
}

std::size_t VolumeBricks::polynomials() const {
    std::size_t count = 0;
    for_each_owned([&](const OwnedBrick& brick) { count += brick.polynomials(); });
    return count;
}

std::size_t VolumeBricks::memory_bytes() const {
    constexpr std::size_t page_bytes = 4096;
    std::vector<std::size_t> pages = made();  // those of the places that were written to
    for (std::size_t& number : pages) {
        number /= page_bytes / sizeof(void*);
    }
    pages.erase(std::unique(pages.begin(), pages.end()), pages.end());
    std::size_t bytes = sizeof(*this) + sizeof(VolumeBrick) + pages.size() * page_bytes;
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
