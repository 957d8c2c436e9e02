#include "downwash/bench/uncertainty_study/uncertainty_study.hpp"

#include <utility>

#include "downwash/simulation/world_parameters.hpp"

namespace downwash::bench {
namespace {

constexpr const char* own_setting = "the problem's own";
constexpr const char* camp_setting = "CAMP's";

/// Everything is nominal.
Uncertainty no_uncertainty() {
    Uncertainty none;
    for (const UncertaintyKey& key : uncertainty_keys()) {
        if (key.spread != nullptr) {
            none.*key.spread = downwash::Spread();
        }
    }
    return none;
}

downwash::Spread exactly(double difference) {
    return downwash::Spread::over(difference, difference);
}

/// The problems of a study with something else uncertain.
std::vector<AnyProblem> with(std::vector<AnyProblem> problems, const std::optional<Uncertainty>& uncertainty) {
    for (AnyProblem& problem : problems) {
        uncertainty_of(problem) = uncertainty;
    }
    return problems;
}

std::vector<AnyProblem> in_worlds(std::vector<AnyProblem> problems, std::uint64_t worlds) {
    for (AnyProblem& problem : problems) {
        planner_of(problem).worlds = worlds;
    }
    return problems;
}

Campaign campaign_of(const StudySettings& settings, const std::string& name) {
    Campaign campaign;
    campaign.name = name;
    campaign.seeds.count = settings.seeds;
    campaign.time_limit_s = settings.time_limit_s;
    campaign.evaluation_worlds = settings.worlds;
    campaign.jobs = settings.jobs;
    return campaign;
}

StudyPart nominal_part(const StudySettings& settings) {
    Campaign campaign = campaign_of(settings, "as_believed");
    campaign.variants = {Variant::mp_arm_ada, Variant::mp_arm_da, Variant::mp_arm};
    campaign.margins_m = {0.05, 0.1, 0.2, 0.3, 0.4};
    return {campaign.name, own_setting, "nominal", false, {campaign, with(settings.problems, {}), settings.problems}};
}

StudyPart pessimistic_part(const StudySettings& settings) {
    Campaign campaign = campaign_of(settings, "pessimistic");
    campaign.margins_m = {0.1};
    std::vector<AnyProblem> problems = in_worlds(with(settings.problems, pessimistic_world()), 2);
    for (AnyProblem& problem : problems) {
        // Its worlds are all the same one: a certificate says nothing, and should cost nothing.
        planner_of(problem).max_failure_probability = 0.5;
        planner_of(problem).confidence = 0.5;
    }
    return {
        campaign.name, own_setting, "one pessimistic world", false, {campaign, std::move(problems), settings.problems}};
}

StudyPart worlds_part(const StudySettings& settings, std::uint64_t worlds) {
    const Campaign campaign = campaign_of(settings, "worlds_" + std::to_string(worlds));
    return {campaign.name,
            own_setting,
            std::to_string(worlds) + " worlds",
            true,
            {campaign, in_worlds(settings.problems, worlds)}};
}

std::vector<StudyPart> camp_parts(const StudySettings& settings) {
    constexpr std::uint64_t particles = 20;  // as CAMP has
    const std::vector<AnyProblem> uncertain = with(settings.problems, camp_uncertainty());
    const Campaign nominal = campaign_of(settings, "camp_as_believed");
    const Campaign robust = campaign_of(settings, "camp_worlds_20");
    return {{nominal.name, camp_setting, "nominal", false, {nominal, with(settings.problems, {}), uncertain}},
            {robust.name, camp_setting, "20 worlds", true, {robust, in_worlds(uncertain, particles)}}};
}

}  // namespace

Uncertainty camp_uncertainty() {
    Uncertainty camp = no_uncertainty();
    camp.mass_scale = downwash::Spread::of_sd(0.07);
    camp.center_of_mass_x_m = camp.center_of_mass_z_m = downwash::Spread::of_sd(0.03);
    camp.inertia_scale = downwash::Spread::of_sd(0.1);
    return camp;
}

Uncertainty pessimistic_world() {
    Uncertainty world = no_uncertainty();
    world.ceiling_scale = exactly(0.4);
    world.scene_z_m = exactly(-0.04);
    world.rotor_time_constant_s = downwash::Spread::of_factor(1.5, 1.5);
    return world;
}

std::vector<StudyPart> parts_of(const StudySettings& settings) {
    std::vector<StudyPart> parts{nominal_part(settings), pessimistic_part(settings)};
    for (const std::uint64_t worlds : {2U, 4U, 8U, 16U}) {
        parts.push_back(worlds_part(settings, worlds));
    }
    for (StudyPart& part : camp_parts(settings)) {
        parts.push_back(std::move(part));
    }
    return parts;
}

CampaignProgress run_study(const std::vector<StudyPart>& parts, const CampaignRunOptions& options) {
    CampaignProgress all;
    for (const StudyPart& part : parts) {
        all.planned += plan_of(part.read).run_count();
    }
    for (const StudyPart& part : parts) {
        CampaignRunOptions own = options;
        own.out = options.out / part.name;
        own.resumes = true;
        const auto planned = static_cast<double>(plan_of(part.read).run_count());
        own.on_progress = [&](double share) {
            if (options.on_progress) {
                options.on_progress((static_cast<double>(all.done) + share * planned) /
                                    static_cast<double>(all.planned));
            }
        };
        all.done += run_campaign(part.read, own).done;
        if (options.stop.stop_requested()) {
            break;
        }
    }
    return all;
}

}  // namespace downwash::bench
