#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string measured = DOWNWASH_MEASUREMENTS;
const std::string tilted = DOWNWASH_TILTED_ROTORS;

}  // namespace

TEST_CASE("A fit prints the model, its parameters, RMSE and count first") {
    const Workspace work;
    const Result result =
        work.succeed("aeromap fit", measured, "--model sanchez-cuevas --surface ceiling --source jirs2024 --json");
    CHECK(result.err.empty());
    const auto fit = nlohmann::ordered_json::parse(result.out);
    auto key = fit.begin();
    for (const std::string& first : words("model parameters rmse n")) {
        REQUIRE(key != fit.end());
        CHECK(key++.key() == first);
    }
    // gnuplot's fit of the same points.
    CHECK(fit["model"] == "sanchez-cuevas");
    CHECK(fit["parameters"].size() == 2);
    CHECK(fit["parameters"]["k1"].get<double>() == Approx(3.15108).epsilon(5e-4));
    CHECK(fit["parameters"]["k2_over_radius"].get<double>() == Approx(1.03004).epsilon(5e-4));
    CHECK(fit["rmse"].get<double>() == Approx(0.0182810).epsilon(1e-5));
    CHECK(fit["n"] == 16);
    CHECK(fit["standard_errors"]["k1"].get<double>() == Approx(0.750247).epsilon(5e-3));
    CHECK(fit["residuals"].size() == 16);
}

TEST_CASE("A fit for people ends with the lines for a problem file, and tells when it is one to several surfaces") {
    const Workspace work;
    const Result result = work.succeed("aeromap fit", measured, "--model he --surface ground --fix b=2");
    CHECK_THAT(result.out, Contains("b = 2  fixed") && Catch::EndsWith(", b: 2}\n") &&
                               Contains("\nFor a problem file:\naero:\n  ground: {model: he, a: 0."));
    write_file(work / "m.csv", "z_over_r,thrust_ratio\n0.5,1.3\n1,1.1\n");
    const std::string plain = work.run("aeromap fit", work / "m.csv", "--model he --surface ceiling").out;
    CHECK_THAT(plain,
               Contains("no standard error: as many parameters as measurements") && Contains("  ceiling: {model: he,"));
    // What its data do not determine it says before.
    write_file(work / "m.csv", "z_over_r,thrust_ratio\n1,1.1\n1.01,1.11\n1.02,1.09\n1.03,1.1\n");
    const Words fit = words("aeromap fit", work / "m.csv", "--model he --surface ceiling");
    const std::string said = work.run(fit).out;
    const auto warned = said.find("Not determined by these measurements: a, b. Keep a known value with --fix");
    REQUIRE(warned != std::string::npos);
    CHECK_THAT(said, !Contains("For a problem file"));
    CHECK_THAT(work.run(fit, "--fix b=2").out, !Contains("ot determined"));
    // At a millionth of a radius no decay changes anything; three measurements are more than two parameters all the
    // same.
    write_file(work / "m.csv", "z_over_r,thrust_ratio\n1e-6,1.01\n2e-6,1.011\n3e-6,1.01\n");
    CHECK_THAT(work.run(fit).out, Contains("a = 0.01033333  no standard error: another parameter is not determined\n"));
    // Without a fountain its distance is nothing that the data could ask for.
    const Words fountain =
        words("aeromap fit", measured, "--model multirotor-body --rotor-spacing 2.5 --surface ground");
    CHECK_THAT(work.run(fountain).out,
               Contains("k_b = 0  at the end of its range: the data ask for a value outside\n") &&
                   Contains("b_over_radius = 100  not determined: other values fit as well\n"));
    CHECK(work.json(fountain).at("at_bound") == nlohmann::json::array({"k_b"}));
    CHECK(work.json(fountain).at("undetermined") == nlohmann::json::array({"b_over_radius"}));
    const Result of_both = work.succeed("aeromap fit", measured, "--model cheeseman-bennett --json");
    CHECK(of_both.json().at("n") == 45);
    CHECK(of_both.json().at("parameters") == nlohmann::json::object());
    CHECK_THAT(of_both.err, Contains("several surfaces"));
}

TEST_CASE("Measurements that are likely no thrust ratios are fitted with a warning and no lines to paste") {
    const Workspace work;
    write_file(work / "percent.csv", "z_over_r,thrust_ratio\n0.5,21\n1,5.8\n2,1.3\n3,0.4\n");
    const Result fit = work.run("aeromap fit", work / "percent.csv", "--model he --surface ground");
    CHECK_THAT(fit.err, Contains("thrust_ratio from 0.4 to 21, far above"));
    CHECK_THAT(fit.out, !Contains("For a problem file"));
}

TEST_CASE("Points can be left out and weighted") {
    const Workspace work;
    write_file(work / "m.csv", "z_over_r,thrust_ratio,sigma\n0.1,3,1\n0.5,1.3,0.1\n1,1.1,0.01\n2,1,0.01\n9,7,1\n");
    const Words fit = words("aeromap fit", work / "m.csv", "--model li --from 0.5 --to 2");
    const auto plain = work.json(fit);
    const auto weighted = work.json(fit, "--weighted");
    CHECK(plain.at("n") == 3);
    CHECK(plain.at("reduced_chi_squared").is_null());
    CHECK(weighted.at("reduced_chi_squared").is_number());
    // The point at 1 pulls towards 1.45, that at 0.5 towards 0.92: with its sigma it counts for more.
    CHECK(weighted.at("parameters").at("rho") > plain.at("parameters").at("rho"));
}

TEST_CASE("A fit is drawn with its measurements and residuals") {
    const Workspace work;
    const Words fit = words("aeromap fit", measured, "--model he --surface ceiling --source jirs2024 --out");
    CHECK_THAT(work.succeed(fit, work / "fit.svg").out, StartsWith("he: "));
    CHECK_THAT(read_file(work / "fit.svg"),
               Contains("<svg") && Contains("he fitted to 16 measurements") && Contains("measured minus model"));
    CHECK(work.run(fit, work / "missing/fit.svg").code == 2);
    check_rejected(work.run(fit, work / "fit.jpeg"), "ends in .svg, .png or .pdf");
}

TEST_CASE("Fits that cannot be made end with 2 and say why") {
    const Workspace work;
    write_file(work.in_run("m.csv"), "z_over_r,thrust_ratio\n1,1.1\n1,1.2\n");
    write_file(work.in_run("bad.csv"), "z_over_r,thrust_ratio\n1,1.1\n1,x\n");
    std::filesystem::copy_file(measured, work.in_run("good.csv"));
    for (const auto& [arguments, reason] : {
             std::pair{"fit", "DATA is required"},
             {"fit good.csv --model liu", "did you mean 'li'?"},
             {"fit good.csv --model table", "a table has no parameters to fit"},
             {"fit missing.csv --model he", "missing.csv cannot be read: there is no such file"},
             {"fit . --model he", "cannot be read"},
             {"fit bad.csv --model he", "bad.csv:3:3: thrust_ratio is 'x'"},
             {"fit m.csv --model he", "m.csv: only 1 different z_over_r; expected at least 2"},
             {"fit m.csv --model he --surface wall", "expected ground or ceiling"},
             {"fit good.csv --model he --surface wall", "expected ceiling or ground"},
             {"fit good.csv --model he --source me", "expected jirs2024 or hydrus15_isolated"},
             {"fit good.csv --model he --from 5", "leave no measurement"},
             {"fit good.csv --model he --fix b", "expected NAME=NUMBER"},
             {"fit good.csv --model he --fix b=2x", "expected NAME=NUMBER"},
             {"fit good.csv --model he --fix c=2", "no parameter 'c'"},
             {"fit good.csv --model he --weighted", "good.csv:5: no sigma; expected one"},
             {"fit good.csv --model he --rotor-spacing 0", "expected radii, above 0"},
             {"fit good.csv --model multirotor-body", "multirotor-body needs the other rotors"},
             {"fit good.csv --model multirotor-images", "expected --rotor-spacing"},
             {"compare good.csv --json --markdown", "expected at most one"},
             {"fit good.csv", "expected --model NAME, --tilt-loss or --walls"},
             {"fit good.csv --tilt-loss --model he", "--tilt-loss fits no model"},
             {"fit good.csv --tilt-loss --surface ground", "expected a column tilt_deg"},
             {"fit good.csv --tilt-loss", "one surface: expected only measurements at ceiling or ground"},
             {"fit good.csv --tilt-loss --rotor-spacing 2.5", "neither --model nor --fix, --weighted, --rotor-spacing"},
             {"fit good.csv --walls --rotor-spacing 2.5", "--walls fits no model"},
             {"fit good.csv --walls --from 1", "--walls takes all of DATA"},
         }) {
        CAPTURE(arguments);
        check_rejected(work.run("aeromap", arguments), reason);
    }
}

TEST_CASE("A comparison lists every model for every source and surface") {
    const Workspace work;
    const auto sets = work.json("aeromap compare", measured).at("data_sets");
    REQUIRE(sets.size() == 3);
    const auto& ceiling = sets[0];
    CHECK(ceiling.at("source") == "jirs2024");
    CHECK(ceiling.at("n") == 16);
    const auto& free_air = ceiling.at("models")[0];
    CHECK(free_air.at("model") == "none");
    CHECK(free_air.at("bands").size() == 4);
    // The mean of 1.232, 1.223, 1.199 and 1.169 is 1.20575.
    CHECK(free_air.at("bands")[0].at("mean_error").get<double>() == Approx(-0.20575));
    CHECK(sets[2].at("models")[0].at("bands")[3].at("mean_error").is_null());

    CHECK_THAT(work.run("aeromap compare", measured, "--markdown").out,
               Contains("| `none` |  | 0.1171 | - | -0.206 |"));
    CHECK_THAT(work.run("aeromap compare", measured).out,
               Contains("jirs2024, ceiling: 16 measurements, z/R 0.328 to 2.297\n"));
}

TEST_CASE("A comparison says for each surface what too high a K does, and a page shows it whole") {
    const Workspace work;
    const std::string markdown = work.run("aeromap compare", measured, tilted, "--rotor-spacing 2.5 --markdown").out;
    CHECK_THAT(markdown, Contains("a ceiling, overstating is careful") && Contains("Over the ground"));
    const std::string page = read_file(DOWNWASH_AEROMAP_PAGE);
    const std::string begin = "<!-- comparison -->\n";
    const auto first = page.find(begin);
    const auto last = page.find("<!-- /comparison -->\n");
    REQUIRE(first < last);
    REQUIRE(last != std::string::npos);
    CHECK(page.substr(first + begin.size(), last - first - begin.size()) == markdown);
}

TEST_CASE("A comparison without a column of surfaces takes all measurements at the surface that is asked for") {
    const Workspace work;
    write_file(work / "m.csv", "z_over_r,thrust_ratio\n0.5,1.3\n1,1.1\n2,1.02\n");
    const auto models_of = [&](const char* more) {
        const auto sets = work.json("aeromap compare", work / "m.csv", more).at("data_sets");
        REQUIRE(sets.size() == 1);
        std::string names = sets[0].at("surface").get<std::string>() + ":";
        for (const auto& model : sets[0].at("models")) {
            names += " " + model.at("model").get<std::string>();
        }
        return names;
    };
    CHECK_THAT(models_of(""), Contains("cheeseman-bennett") && Contains("sanchez-cuevas"));
    CHECK_THAT(models_of("--surface ceiling"), StartsWith("ceiling: none sanchez-cuevas"));
    CHECK_THAT(models_of("--surface ground"), !Contains("sanchez-cuevas"));
    check_rejected(work.run("aeromap compare", work / "m.csv", "--surface cieling"), "did you mean 'ceiling'?");
    write_file(work / "m.csv", "z_over_r,thrust_ratio,surface\n0.5,1.3,grond\n");
    write_file(work / "n.csv", "z_over_r,thrust_ratio,surface\n0.5,1.3,ground\n");
    check_rejected(work.run("aeromap compare", work / "n.csv", work / "m.csv"),
                   "m.csv:2:9: has the surface 'grond'; expected ground or ceiling; did you mean 'ground'?");
}

TEST_CASE(
    "The tilt loss is fitted with its error, beside the level disc and other arrangements, and the page quotes it") {
    const Workspace work;
    const auto fit = work.json("aeromap fit", tilted, "--tilt-loss");
    CHECK(fit.at("tilt_loss").get<double>() == Approx(0.37).margin(0.01));
    CHECK(fit.at("n") == 53);
    CHECK(fit.at("rmse").get<double>() < 0.5 * fit.at("as_level").at("rmse").get<double>());
    CHECK(fit.at("left_out").size() == 2);
    const std::string text = work.run("aeromap fit", tilted, "--tilt-loss").out;
    CHECK_THAT(text, StartsWith("tilt_loss = 0.365 +- "));
    CHECK_THAT(read_file(DOWNWASH_AEROMAP_PAGE), Contains("<!-- tilt -->\n```\n" + text + "```\n<!-- /tilt -->\n"));
}

TEST_CASE("Fits of tilt and walls say where they end at a bound, and no standard error there") {
    const Workspace work;
    write_file(work / "m.csv", "z_over_r,thrust_ratio,tilt_deg\n1,1.1,0\n2,1.05,0\n1,1,10\n2,1,10\n");
    const std::string outside = "  at the end of its range: the data ask for a value outside\n";
    CHECK_THAT(work.run("aeromap fit", work / "m.csv", "--tilt-loss").out, StartsWith("tilt_loss = 100" + outside));
    const auto tilt = work.json("aeromap fit", work / "m.csv", "--tilt-loss");
    CHECK(tilt.at("at_bound") == true);
    CHECK(tilt.at("standard_error").is_null());
    CHECK(work.json("aeromap fit", tilted, "--tilt-loss").at("at_bound") == false);
    const std::string header = "distance_over_r,force_over_thrust,moment_over_thrust_radius\n";
    write_file(work / "w.csv", header + "1,0.01,0.03\n2,0.01,0.03\n");
    CHECK_THAT(work.run("aeromap fit", work / "w.csv", "--walls").out, Contains("\ndecay_radii = 20.00" + outside));
    CHECK(work.json("aeromap fit", work / "w.csv", "--walls").at("at_bound") == true);
    write_file(work / "w.csv", header + "1,0.01,0\n2,0.01,0\n");
    check_rejected(work.run("aeromap fit", work / "w.csv", "--walls"), "the moments tell no decay");
}

TEST_CASE("A comparison of several files says how far all of them scatter about each model") {
    const Workspace work;
    const auto compared = work.json("aeromap compare", measured, tilted);
    CHECK(compared.at("data_sets").size() == 10);
    bool has_default = false;
    for (const auto& model : compared.at("scatter")) {
        if (model.at("model") == "sanchez-cuevas") {
            has_default = true;
            CHECK(model.at("surface") == "ceiling");
            CHECK(model.at("from_half_a_radius").at("scatter").get<double>() == Approx(0.15).margin(0.005));
            CHECK(model.at("from_half_a_radius").at("n") == 22);
        }
    }
    CHECK(has_default);
    CHECK_THAT(work.run("aeromap compare", measured, tilted).out, Contains("+- 0.45"));
}

TEST_CASE("A model is fitted to level rotors, whatever else the file holds") {
    const Workspace work;
    const Result result = succeeded(work.run("aeromap fit", tilted, "--model he --json"));
    CHECK_THAT(result.err, Contains("53 measurements of tilted rotors are left out; --tilt-loss fits those"));
    CHECK(work.json("aeromap fit", tilted, "--model he --source bench_coplanar").at("n") == 9);
    CHECK_THAT(result.out, Contains("\"n\": 9"));
    check_rejected(work.run("aeromap fit", tilted, "--model he --source bench_face_to_face"), "tilted rotors only");
}
