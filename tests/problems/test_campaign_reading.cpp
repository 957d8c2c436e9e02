#include "downwash/problems/campaign_reader.hpp"
#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr std::string_view good_campaign = R"(schema: downwash/campaign/v1
name: trial
problems: [problem.yaml]
variants: [mp-arm, mp-arm-ada]
objectives: [energy, time]
margins_m: [0.05, 0.2]
seeds: {first: 3, count: 2}
time_limit_s: 0.5
expect: [{variant: mp-arm-ada, solved_ratio: 0.9, failed_flights: 0}]
)";

struct CampaignFolder {
    TestFolder folder;

    CampaignFolder() { static_cast<void>(folder.read()); }

    [[nodiscard]] ReadCampaign read(std::string_view text) const {
        folder.write("campaign.yaml", text);
        return read_campaign(folder / "campaign.yaml");
    }

    /// Errors after one change to the sound campaign, without the folder's path.
    [[nodiscard]] std::string errors_after(std::string_view from, std::string_view to) const {
        return folder.errors_in([&] { return read(edited(good_campaign, from, to)); });
    }
};

}  // namespace

TEST_CASE("a campaign is read with its problems, whose paths are relative to it") {
    const CampaignFolder folder;
    const ReadCampaign read = folder.read(good_campaign);
    const Campaign& campaign = read.campaign;
    const std::vector<AnyProblem>& problems = read.problems;
    CHECK(campaign.name == "trial");
    REQUIRE(problems.size() == 1);
    CHECK(problem_name(problems[0]) == "test");
    CHECK(campaign.variants == std::vector{Variant::mp_arm, Variant::mp_arm_ada});
    CHECK(campaign.objectives.value() == std::vector{Objective::energy, Objective::time});
    CHECK(campaign.algorithms == std::vector<std::string>{"rrt-star"});
    CHECK(campaign.margins_m == std::vector{0.05, 0.2});
    CHECK(campaign.seeds.all() == std::vector<std::uint32_t>{3, 4});
    CHECK(campaign.time_limit_s == 0.5);
    CHECK_FALSE(campaign.jobs.has_value());
    REQUIRE(campaign.expect.size() == 1);
    CHECK(campaign.expect[0].solved_ratio == 0.9);
    CHECK(campaign.expect[0].failed_flights == 0U);
    CHECK_FALSE(campaign.expect[0].first_solution_95_s.has_value());
    CHECK(campaign.evaluation_worlds == 0);
    CHECK(folder.read(std::string(good_campaign) + "evaluation_worlds: 300\n").campaign.evaluation_worlds == 300);
    CHECK_THAT(folder.errors_after("failed_flights: 0", "max_failure_share: 0.01"),
               Catch::Contains("max_failure_share asks for flights in worlds, but none are flown"));
    // The parameters of its algorithms may vary, and the seeds may be a list.
    CHECK(folder.read(std::string(good_campaign) + "parameters: [{}, {goal_bias: 0.2, batch_size: 16}]\n")
              .campaign.parameters == std::vector<ParameterValues>{{}, {{"batch_size", 16}, {"goal_bias", 0.2}}});
    CHECK(folder.read(edited(good_campaign, "{first: 3, count: 2}", "[7, 1, 4294967295]")).campaign.seeds.all() ==
          std::vector<std::uint32_t>{7, 1, 4294967295U});
}

TEST_CASE("a nominal campaign plans without uncertainty and judges with it") {
    const CampaignFolder folder;
    folder.folder.write("problem.yaml", std::string(good_problem) + "uncertainty: {}\n");
    const ReadCampaign usual = folder.read(good_campaign);
    CHECK(uncertainty_of(usual.problems[0]).has_value());
    CHECK(usual.evaluated_in.empty());
    const ReadCampaign believed = folder.read(std::string(good_campaign) + "as_believed: true\n");
    CHECK_FALSE(uncertainty_of(believed.problems[0]).has_value());
    REQUIRE(believed.evaluated_in.size() == 1);
    CHECK(uncertainty_of(believed.evaluated_in[0]).has_value());
}

TEST_CASE("what cannot be run in a campaign is an error with its place and a remedy") {
    static const Edit edits[] = {
        {"campaign/v1", "campaign/v2",
         "1:9: schema is 'downwash/campaign/v2': expected downwash/campaign/v1, no other is read"},
        {"margins_m", "margin_m", "6:1: unknown key 'margin_m' at the top: did you mean 'margins_m'?"},
        {"[mp-arm, mp-arm-ada]", "[mp-arm, mp-arm-adda]",
         "4:11: variants has 'mp-arm-adda': expected a list of mp-arm, mp-arm-da or mp-arm-ada; did you mean "
         "'mp-arm-ada'?"},
        {"[mp-arm, mp-arm-ada]", "mp-arm",
         "4:11: variants is 'mp-arm': expected a list of mp-arm, mp-arm-da or mp-arm-ada"},
        {"[energy, time]", "[]", "5:13: objectives is empty: expected a list of <objectives>, or null"},
        {"[energy, time]", "[time, time]",
         "5:13: objectives has 'time' twice: expected a list of <objectives>, or null"},
        {"[0.05, 0.2]", "[0.05, -1]",
         "6:12: margins_m is -1: expected a list of different numbers in m from 0 to 100, or null"},
        {"{first: 3, count: 2}", "[1, 2.5]",
         "7:12: seeds is '2.5': expected a group of keys or a list of whole numbers from 0 to 4294967295"},
        {"{first: 3, count: 2}", "[5, 6, 5]",
         "7:8: seeds has 5 twice: expected a group of keys or a list of whole numbers from 0 to 4294967295"},
        {"first: 3", "first: 4294967295",
         "7:1: seeds go beyond 4294967295, the highest seed: expected a smaller first or count"},
        {"count: 2", "count: 200000",
         "7:1: seeds make more than 1000000 runs with all problems, variants, algorithms, objectives, margins and "
         "parameters: expected fewer of one of them"},
        {"margins_m: [0.05, 0.2]", "parameters: [{}, {goal_bais: 0.2}]",
         "6:19: unknown key 'goal_bais' in parameters[1]: did you mean 'goal_bias'?"},
        {"margins_m: [0.05, 0.2]", "parameters: [{goal_bias: 1.5}]",
         "6:26: parameters[0].goal_bias is 1.5: expected a number from 0 to 1, or null"},
        {"margins_m: [0.05, 0.2]", "parameters: [{batch_size: 1.5}]",
         "6:27: parameters[0].batch_size is 1.5: expected a whole number"},
        {"margins_m: [0.05, 0.2]", "parameters: [{pruning_radius: 1}]",
         "6:31: parameters[0].pruning_radius has a meaning only with sst: remove it"},
        {"margins_m: [0.05, 0.2]", "parameters: [{}, {goal_bias: 0.2}, {}]",
         "6:36: parameters[2] is the same as parameters[0]: expected every set once"},
        {"variant: mp-arm-ada", "variant: mp-arm-da",
         "9:20: expect[0].variant is mp-arm-da, which is not run: expected one of the campaign's variants"},
        {"failed_flights: 0", "algorithm: sst",
         "9:62: expect[0].algorithm is sst, which is not run: expected one of the campaign's algorithms"},
        {"failed_flights: 0", "cost_to_best: 1.05",
         "9:65: expect[0].cost_to_best does not say when: expected cost_after_s beside it"},
        {"failed_flights: 0", "cheaper_than_after_s: 30",
         "9:73: expect[0].cheaper_than_after_s is half of a comparison: expected cheaper_than and cheaper_than_after_s "
         "together"},
        {"[problem.yaml]", "[problem.yaml, ./problem.yaml]",
         "3:11: problems name './problem.yaml', which has the name of another, test: expected every problem once, with "
         "a name of its own"}};
    const CampaignFolder folder;
    check(edits, "campaign.yaml", [&folder](auto from, auto to) { return folder.errors_after(from, to); });
    CHECK(folder.errors_after("[problem.yaml]", "[none.yaml]") ==
          "none.yaml:1:1: cannot be read: there is no such file");
    // Errors of its problems are reported where they stand.
    folder.folder.write("problem.yaml", edited(good_problem, "seed: 1", "sead: 1"));
    CHECK(folder.errors_after("trial", "other") ==
          "problem.yaml:16:72: unknown key 'sead' in planner: did you mean 'seed'?");
}

TEST_CASE("former names of keys in a campaign's problems are reported") {
    const CampaignFolder folder;
    folder.folder.write("robot.yaml", edited(good_robot, "{kp: 8, ", "{k5: 8, "));
    folder.folder.write("campaign.yaml", good_campaign);
    std::string reported;
    static_cast<void>(
        read_campaign(folder.folder / "campaign.yaml", [&](const LocatedError& key) { reported += key.message; }));
    CHECK(reported == "controller.attitude.k5 is now called kp: rename it");
}

TEST_CASE("every parameter of a campaign is described and has a sound default unless it must be given") {
    for (const Parameter<Campaign>& row : campaign_parameters().rows()) {
        CAPTURE(row.path);
        CHECK_FALSE(row.description.empty());
        if (row.get && !row.required && row.path.find("[]") == std::string::npos) {
            CHECK_FALSE(value_error(row, row.get(Campaign{}, 0)).has_value());
        }
    }
}

TEST_CASE("the shipped campaigns are sound, and the one of all problems forgets none") {
    const std::filesystem::path folder = DOWNWASH_CAMPAIGNS;
    std::size_t campaigns = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".yaml") {
            CAPTURE(entry.path());
            CHECK_NOTHROW(read_campaign(entry.path()));
            ++campaigns;
        }
    }
    CHECK(campaigns >= 5);
    std::size_t shipped = 0;
    for (const auto& entry : std::filesystem::directory_iterator(DOWNWASH_PROBLEMS)) {
        shipped += entry.path().extension() == ".yaml" ? 1 : 0;
    }
    CHECK(read_campaign(folder / "all.yaml").problems.size() == shipped);
}
