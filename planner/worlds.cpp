#include "downwash/planner/worlds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/search/planned_flights.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash::planning {
namespace {

/// Worlds in which the dangers come early: strong suction under a low scene with slow rotors; the reverse; wind
/// and bias from either side; then points spread evenly.
std::vector<double> search_quantiles(std::uint64_t number) {
    const std::span<const WorldParameter> parameters = world_parameters();
    std::vector<double> quantiles(parameters.size(), 0.5);
    const auto set = [&](std::string_view name, double quantile) {
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            if (parameters[i].name.starts_with(name)) {
                quantiles[i] = quantile;
            }
        }
    };
    constexpr double far = 0.98;
    if (number <= 2) {
        const bool is_strong = number == 1;
        set("aero.ceiling_scale", is_strong ? far : 1 - far);
        set("aero.ground_scale", is_strong ? far : 1 - far);
        set("aero.scene_offset_m.z", is_strong ? 1 - far : far);
        set("vehicle.rotor_time_constant_s", is_strong ? far : 0.5);
        set("vehicle.delay_s", is_strong ? far : 0.5);
        set("sensing.position_bias_m z", is_strong ? 0.1 : 0.9);
        set("wind.steady_m_s.z", is_strong ? 0.9 : 0.1);
        return quantiles;
    }
    if (number <= 4) {
        const double side = number == 3 ? far : 1 - far;
        set("aero.ceiling_scale", 0.85);
        set("aero.scene_offset_m.x", side);
        set("aero.scene_offset_m.z", 0.2);
        set("vehicle.com_offset_m.x", side);
        set("sensing.position_bias_m x", side);
        set("sensing.pitch_bias_deg", side);
        set("wind.steady_m_s.x", side);
        return quantiles;
    }
    // Kronecker's sequence with the generalised golden ratio (Roberts 2018).
    double phi = 2;
    for (int i = 0; i < 30; ++i) {
        double power = 1;
        for (std::size_t k = 0; k < parameters.size(); ++k) {
            power *= phi;
        }
        phi = phi - (power * phi - phi - 1) / (static_cast<double>(parameters.size() + 1) * power - 1);
    }
    double step = 1;
    for (double& quantile : quantiles) {
        step /= phi;
        const double place = 0.5 + static_cast<double>(number) * step;
        quantile = place - std::floor(place);
    }
    return quantiles;
}

ReferenceSegment segment_of(const Plan& plan, std::size_t to) {
    const ReferenceKnot& a = plan.reference[to - 1];
    const ReferenceKnot& b = plan.reference[to];
    return {a.point, b.point, b.tick - a.tick, plan.tick_s};
}

}  // namespace

ProblemWorlds::ProblemWorlds(const Problem& problem, std::shared_ptr<const FlightModel> model, const AeroMap* map,
                             const SolveOptions& options)
    : problem_(problem), model_(std::move(model)), map_(map), threads_(options.threads), stop_(options.stop) {
    if (map_ != nullptr) {
        ceiling_.model = model_->ceilings_only();
        if (ceiling_.model != nullptr) {
            ceiling_.map = ceiling_.model->make_map(problem.bounds, options.threads, {}, options.map_cache);
        }
    }
}

std::vector<std::optional<FlightState>> ProblemWorlds::starts_in(const std::vector<FlownWorld>& worlds) const {
    const FlightState believed = start_state(*model_, problem_.start);
    std::vector<std::optional<FlightState>> starts(worlds.size(), believed);
    if (is_at_rest(problem_.start)) {
        const ReferencePoint here = at_rest(problem_.start.configuration());
        const double tick_s = model_->tick().tick_s;
        const ReferenceSegment hover(here, here, std::llround(settling_before_start_s / tick_s), tick_s);
        std::vector<FlownWorld> quiet;
        quiet.reserve(worlds.size());
        std::vector<FlightJob> jobs;
        for (const FlownWorld& world : worlds) {
            quiet.push_back(without_noise(world));
            FlightJob job{believed, {{hover}}, 0, &quiet.back()};
            job.start.world = memory_at_start(quiet.back(), believed.plant);
            jobs.push_back(std::move(job));
        }
        FlightPool(*model_, map_, rules_of_execution(), nullptr, threads_, best_instructions(), &ceiling_).fly(jobs);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            starts[i] = jobs[i].rejection() == Rejection::none ? std::optional(jobs[i].end()) : std::nullopt;
        }
    }
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (starts[i]) {
            starts[i]->plant.energy_j = 0;
            starts[i]->world = memory_at_start(worlds[i], starts[i]->plant);
        }
    }
    return starts;
}

void ProblemWorlds::fly_part(std::vector<FlightJob>& jobs, const Plan& plan, std::size_t first, std::size_t last,
                             const Goal* goal) const {
    const std::int64_t judged_ticks = std::llround(goal_settling_s / model_->tick().tick_s);
    std::vector<FlightLeg> legs;
    for (std::size_t i = first + 1; i <= last; ++i) {
        legs.push_back({segment_of(plan, i)});
    }
    std::vector<FlightJob> flying;
    std::vector<FlightJob*> owners;
    for (FlightJob& job : jobs) {
        if (job.rejection() == Rejection::none) {
            flying.push_back({job.legs.empty() ? job.start : job.end(), legs, goal != nullptr ? judged_ticks : 0,
                              job.world, plan.reference[first].tick});
            owners.push_back(&job);
        }
    }
    FlightPool(*model_, map_, rules_of_execution(), goal, threads_, best_instructions(), &ceiling_).fly(flying);
    for (std::size_t i = 0; i < flying.size(); ++i) {
        owners[i]->legs = std::move(flying[i].legs);
    }
}

SearchWorlds ProblemWorlds::for_search(const Course& before) const {
    SearchWorlds search;
    search.ceiling = ceiling_;
    for (std::uint64_t i = 1; i < problem_.planner.worlds; ++i) {
        const std::uint64_t tape = simulation::mixed(~std::uint64_t{problem_.planner.seed} ^ simulation::mixed(i));
        search.worlds.push_back(
            make_world(problem_.robot, world_at(*problem_.uncertainty, problem_.robot, search_quantiles(i), tape)));
    }
    const std::vector<std::optional<FlightState>> starts = starts_in(search.worlds);
    std::vector<FlightJob> jobs;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        if (!starts[i]) {
            throw_input_error(
                "is so wide that the vehicle cannot hover at its start in one of the worlds of the search: "
                "expected less, or a controller that bears it",
                "uncertainty");
        }
        jobs.push_back({*starts[i], {}, 0, &search.worlds[i]});
    }
    std::size_t knot = 0;
    for (const std::size_t end : before.hold_knots) {
        fly_part(jobs, before.plan, std::exchange(knot, end), end, nullptr);
    }
    for (const FlightJob& job : jobs) {
        search.start.push_back(job.legs.empty() ? job.start : job.end());
    }
    return search;
}

std::vector<Rejection> ProblemWorlds::outcomes_of(const Course& before, const Plan& whole, const Goal& goal,
                                                  const std::vector<FlownWorld>& worlds) const {
    const std::vector<std::optional<FlightState>> starts = starts_in(worlds);
    std::vector<Rejection> outcomes(worlds.size(), Rejection::unstable);
    std::vector<FlightJob> jobs;
    std::vector<std::size_t> world_of;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (starts[i]) {
            jobs.push_back({*starts[i], {}, 0, &worlds[i]});
            world_of.push_back(i);
        }
    }
    std::size_t knot = 0;
    for (std::size_t stop = 0; stop < before.hold_knots.size(); ++stop) {
        const std::size_t end = before.hold_knots[stop];
        fly_part(jobs, whole, std::exchange(knot, end), end, &before.goals[stop]);
    }
    Plan held = whole;
    held.reference.push_back(held.reference.back());
    held.reference.back().tick += hold_ticks(goal, *model_, held.reference.back().point);
    fly_part(jobs, held, knot, held.reference.size() - 1, &goal);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        outcomes[world_of[i]] = jobs[i].rejection();
    }
    return outcomes;
}

Certificate ProblemWorlds::certify(const Course& before, const Plan& whole, const Goal& goal,
                                   std::uint64_t attempt) const {
    const PlannerSettings& settings = problem_.planner;
    const CertificateTest test(settings.max_failure_probability, settings.confidence, attempt);
    constexpr std::uint64_t worlds_per_attempt = 1'000'000;
    constexpr std::uint64_t chunk = 64;  // worlds side by side: a bad plan fails in the first of them
    constexpr std::size_t most_listed = 10;
    Certificate certificate;
    certificate.max_failure_probability = settings.max_failure_probability;
    certificate.confidence = settings.confidence;
    certificate.attempts = attempt;
    while (certificate.failures <= CertificateTest::most_failures && !certificate.is_given && !stop_.stop_requested()) {
        const std::uint64_t wanted = test.stage_worlds(certificate.failures) - certificate.worlds;
        std::vector<FlownWorld> worlds;
        for (std::uint64_t i = 0; i < std::min(chunk, wanted); ++i) {
            const std::uint64_t index = attempt * worlds_per_attempt + certificate.worlds + i;
            worlds.push_back(
                make_world(problem_.robot, draw_world(*problem_.uncertainty, problem_.robot, settings.seed, index)));
        }
        const std::vector<Rejection> outcomes = outcomes_of(before, whole, goal, worlds);
        for (const Rejection outcome : outcomes) {
            if (outcome != Rejection::none) {
                ++certificate.failures;
                ++certificate.causes[cause_of(outcome)];
                if (certificate.failed.size() < most_listed) {
                    certificate.failed.push_back(
                        {attempt * worlds_per_attempt + certificate.worlds, cause_of(outcome)});
                }
            }
            ++certificate.worlds;
        }
        certificate.is_given = certificate.failures <= CertificateTest::most_failures &&
                               certificate.worlds >= test.stage_worlds(certificate.failures);
    }
    const double alpha = 0.5 * (1 - settings.confidence);
    const auto n = static_cast<double>(std::max<std::uint64_t>(1, certificate.worlds));
    certificate.failure_probability = {
        static_cast<double>(certificate.failures) / n,
        certificate.failures == 0
            ? 0
            : 1 - failure_bound(certificate.worlds - certificate.failures, certificate.worlds, alpha),
        failure_bound(certificate.failures, certificate.worlds, alpha)};
    return certificate;
}

}  // namespace downwash::planning
