#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "../support/scratch_folder.hpp"
#include "../support/test_problem.hpp"
#include "downwash/bench/uncertainty_study/uncertainty_figures.hpp"
#include "downwash/simulation/world_parameters.hpp"

using namespace downwash;
using namespace downwash::bench;
using Catch::Contains;
using downwash::test::ScratchFolder;

namespace {

/// The study in miniature: one problem whose mass alone is uncertain, one seed, a few worlds.
StudySettings small_study() {
    StudySettings settings;
    Problem problem = test::ceiling_problem();
    problem.uncertainty = camp_uncertainty();
    problem.uncertainty->center_of_mass_x_m = problem.uncertainty->center_of_mass_z_m = downwash::Spread();
    settings.problems = {problem};
    settings.seeds = 1;
    settings.time_limit_s = 0.2;
    settings.worlds = 3;
    settings.jobs = 1;
    return settings;
}

SetupFigures setup(const std::string& name, std::size_t reliable, std::size_t attempted, bool certifies = false) {
    SetupFigures figures;
    figures.setting = "own";
    figures.setup = name;
    figures.attempted = attempted;
    figures.reliable = share_of(reliable, attempted);
    figures.certifies = certifies;
    return figures;
}

const Finding& named(const std::vector<Finding>& findings, const std::string& begin) {
    const auto found =
        std::find_if(findings.begin(), findings.end(), [&](const Finding& f) { return f.name.starts_with(begin); });
    REQUIRE(found != findings.end());
    return *found;
}

}  // namespace

TEST_CASE("the parts of the study differ in what planners believe, and their plans fly in the problem's worlds") {
    const StudySettings settings = small_study();
    const std::vector<StudyPart> parts = parts_of(settings);
    CHECK(parts.size() == 8);
    std::set<std::string> names;
    for (const StudyPart& part : parts) {
        CAPTURE(part.name);
        names.insert(part.name);
        const auto& judging = part.read.evaluated_in.empty() ? part.read.problems : part.read.evaluated_in;
        REQUIRE(judging.size() == 1);
        REQUIRE(uncertainty_of(judging[0]).has_value());
        const bool is_camp = part.setting == "CAMP's";
        CHECK((uncertainty_of(judging[0])->center_of_mass_x_m.form == downwash::Spread::Form::sd) == is_camp);
        CHECK(part.certifies == part.read.evaluated_in.empty());
        CHECK(part.read.campaign.evaluation_worlds == 3);
    }
    CHECK(names.size() == parts.size());
    CHECK_FALSE(uncertainty_of(parts[0].read.problems[0]).has_value());
    // All worlds of the pessimistic planner are the same.
    const auto& pessimistic = std::get<Problem>(parts[1].read.problems[0]);
    for (const std::uint64_t index : {1U, 2U}) {
        const World world = draw_world(*pessimistic.uncertainty, pessimistic.robot, 1, index);
        CHECK(world.ceiling_scale == 0.4);
        CHECK(world.scene_z_m == -0.04);
        CHECK(world.mass_scale == 0);
    }
}

TEST_CASE("the study runs, resumes and reports in miniature") {
    const ScratchFolder folder;
    const std::vector<StudyPart> parts = parts_of(small_study());
    CampaignRunOptions options;
    options.out = folder / "study";
    options.map_cache = folder / "maps";
    const CampaignProgress progress = run_study(parts, options);
    CHECK(progress.planned == 22);
    CHECK(progress.done == 22);
    const StudyFigures figures = figures_of(parts, options.out);
    CHECK(figures.done == 22);
    REQUIRE(figures.setups.size() == 22);
    CHECK(figures.by_problem.size() == 22);
    const SetupFigures& reference = figures.setups.front();
    CHECK(reference.setup == reference_setup);
    REQUIRE(reference.in_worlds.flown == 1);
    CHECK(reference.in_worlds.failed.attempts == 3);
    CHECK(reference.cost_ratio.median == 1);
    CHECK_FALSE(reference.certifies);
    // Nothing is run twice.
    CHECK(run_study(parts, options).done == 22);
    CHECK(json_of(figures_of(parts, options.out)) == json_of(figures));

    const auto json = nlohmann::json::parse(json_of(figures));
    CHECK(json["study"] == "uncertainty");
    CHECK(json["findings"].size() == figures.findings.size());
    CHECK(json["findings"][0]["thesis"].is_null());
    CHECK(json["findings"][0]["reproduced"].is_boolean());
    CHECK(json["setups"].size() == 44);
    CHECK_THAT(markdown_of(figures), Contains("22 of 22 runs done") && Contains("| mp-arm-ada, 8 worlds |"));
}

TEST_CASE("claims are measured against their targets, and fail without runs") {
    std::vector<SetupFigures> setups{setup(reference_setup, 2, 10), setup("mp-arm, nominal, margin 0.4 m", 6, 10),
                                     setup("mp-arm-ada, one pessimistic world, margin 0.1 m", 9, 10),
                                     setup("mp-arm-ada, 8 worlds", 8, 10, true)};
    for (const Finding& finding : findings_of(setups)) {
        CAPTURE(finding.name);
        CHECK(finding.is_reproduced == (finding.name.find("best margin") != std::string::npos));
    }
    setups[0].in_worlds.failed = {30, 100};
    setups[3].in_worlds.failed = {1, 100};
    setups[3].cost_ratio.median = 1.2;
    setups[3].pairs = 8;
    const std::vector<Finding> findings = findings_of(setups);
    CHECK(named(findings, "failure share of certified plans").measured == 0.01);
    CHECK(named(findings, "failure share of certified plans").is_reproduced);
    CHECK(named(findings, "failure share of nominal plans").measured == 0.3);
    CHECK(named(findings, "failure share of nominal plans").is_reproduced);
    CHECK(*named(findings, "searches with a reliable plan, 8 worlds over the best").measured == Approx(0.2));
    CHECK(*named(findings, "searches with a reliable plan, 8 worlds over one").measured == Approx(-0.1));
    CHECK_FALSE(named(findings, "searches with a reliable plan, 8 worlds over one").is_reproduced);
    CHECK_FALSE(named(findings, "cost of plans").is_reproduced);
    CHECK_FALSE(named(findings, "failure share of certified plans in CAMP's").measured.has_value());
}
