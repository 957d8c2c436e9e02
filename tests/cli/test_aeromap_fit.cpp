#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test

TEST_CASE("A fit prints the model, its parameters, RMSE and count first") {
    const ScratchFolder folder;
    const Result result = run(folder, {"aeromap", "fit", DOWNWASH_MEASUREMENTS, "--model", "sanchez-cuevas",
                                       "--surface", "ceiling", "--source", "jirs2024", "--json"});
    REQUIRE(result.code == 0);
    CHECK(result.err.empty());
    const auto fit = nlohmann::ordered_json::parse(result.out);
    std::vector<std::string> keys;
    for (const auto& [key, value] : fit.items()) {
        keys.push_back(key);
    }
    REQUIRE(keys.size() >= 4);
    keys.resize(4);
    CHECK(keys == std::vector<std::string>{"model", "parameters", "rmse", "n"});
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

TEST_CASE("A fit for people ends with what a problem file wants") {
    const ScratchFolder folder;
    const Result result =
        run(folder, {"aeromap", "fit", DOWNWASH_MEASUREMENTS, "--model", "he", "--surface", "ground", "--fix", "b=2"});
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Catch::Contains("b = 2  fixed"));
    CHECK_THAT(result.out, Catch::Contains("\nFor a problem file:\naero:\n  ground: {model: he, a: 0."));
    CHECK_THAT(result.out, Catch::EndsWith(", b: 2}\n"));
    write_file(folder / "m.csv", "z_over_r,thrust_ratio\n0.5,1.3\n1,1.1\n");
    const Result plain = run(folder, {"aeromap", "fit", folder / "m.csv", "--model", "he", "--surface", "ceiling"});
    CHECK_THAT(plain.out, Catch::Contains("no standard error: as many parameters as measurements"));
    CHECK_THAT(plain.out, Catch::Contains("  ceiling: {model: he,"));
}

TEST_CASE("A fit that its data do not determine says so before it offers the problem file's lines") {
    const ScratchFolder folder;
    write_file(folder / "m.csv", "z_over_r,thrust_ratio\n1,1.1\n1.01,1.11\n1.02,1.09\n1.03,1.1\n");
    const std::string said =
        run(folder, {"aeromap", "fit", folder / "m.csv", "--model", "he", "--surface", "ceiling"}).out;
    const auto warned = said.find("Not determined by these measurements: a, b. Keep a known value with --fix");
    REQUIRE(warned != std::string::npos);
    CHECK(warned < said.find("For a problem file"));
    const Result fixed =
        run(folder, {"aeromap", "fit", folder / "m.csv", "--model", "he", "--surface", "ceiling", "--fix", "b=2"});
    CHECK_THAT(fixed.out, !Catch::Contains("ot determined"));
}

TEST_CASE("A fit to several surfaces at once says that it is one") {
    const ScratchFolder folder;
    const Result result =
        run(folder, {"aeromap", "fit", DOWNWASH_MEASUREMENTS, "--model", "cheeseman-bennett", "--json"});
    CHECK(result.code == 0);
    CHECK(result.json().at("n") == 45);
    CHECK(result.json().at("parameters") == nlohmann::json::object());
    CHECK_THAT(result.err, Catch::Contains("several surfaces"));
}

TEST_CASE("Points can be left out and weighted") {
    const ScratchFolder folder;
    write_file(folder / "m.csv", "z_over_r,thrust_ratio,sigma\n0.1,3,1\n0.5,1.3,0.1\n1,1.1,0.01\n2,1,0.01\n9,7,1\n");
    const std::vector<std::string> fit{"aeromap", "fit", folder / "m.csv", "--model", "li",
                                       "--from",  "0.5", "--to",           "2"};
    auto arguments = fit;
    arguments.emplace_back("--json");
    const auto plain = run(folder, arguments).json();
    arguments.emplace_back("--weighted");
    const auto weighted = run(folder, arguments).json();
    CHECK(plain.at("n") == 3);
    CHECK(plain.at("reduced_chi_squared").is_null());
    CHECK(weighted.at("reduced_chi_squared").is_number());
    // The point at 1 pulls towards 1.45, that at 0.5 towards 0.92: with its sigma it counts for more.
    CHECK(weighted.at("parameters").at("rho") > plain.at("parameters").at("rho"));
}

TEST_CASE("A fit is drawn with its measurements and residuals") {
    const ScratchFolder folder;
    const std::vector<std::string> fit{"aeromap",          "fit",       DOWNWASH_MEASUREMENTS,
                                       "--model",          "he",        "--plot",
                                       folder / "fit.svg", "--surface", "ceiling",
                                       "--source",         "jirs2024"};
    const Result result = run(folder, fit);
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Catch::StartsWith("he: "));
    const std::string picture = read_file(folder / "fit.svg");
    CHECK_THAT(picture, Catch::Contains("<svg"));
    CHECK_THAT(picture, Catch::Contains("he fitted to 16 measurements"));
    CHECK_THAT(picture, Catch::Contains("measured minus model"));
    auto nowhere = fit;
    nowhere[6] = folder / "missing/fit.svg";
    CHECK(run(folder, nowhere).code == 2);
    nowhere[6] = folder / "fit.jpeg";
    const Result refused = run(folder, nowhere);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Catch::Contains("ends in .svg, .png or .pdf"));
}

TEST_CASE("Fits that cannot be made end with 2 and say why") {
    const ScratchFolder folder;
    write_file(folder / "m.csv", "z_over_r,thrust_ratio\n1,1.1\n1,1.2\n");
    write_file(folder / "bad.csv", "z_over_r,thrust_ratio\n1,1.1\n1,x\n");
    const std::string good = DOWNWASH_MEASUREMENTS;
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrongs{
        {{"aeromap", "fit"}, "DATA is required"},
        {{"aeromap", "fit", good}, "--model is required"},
        {{"aeromap", "fit", good, "--model", "liu"}, "did you mean 'li'?"},
        {{"aeromap", "fit", good, "--model", "table"}, "a table has no parameters to fit"},
        {{"aeromap", "fit", "missing.csv", "--model", "he"}, "missing.csv: cannot be read: there is no such file"},
        {{"aeromap", "fit", ".", "--model", "he"}, "cannot be read"},
        {{"aeromap", "fit", folder / "bad.csv", "--model", "he"}, "bad.csv:3: thrust_ratio is 'x'"},
        {{"aeromap", "fit", folder / "m.csv", "--model", "he"}, "1 different z_over_r; expected at least 2"},
        {{"aeromap", "fit", folder / "m.csv", "--model", "he", "--surface", "wall"}, "expected ground or ceiling"},
        {{"aeromap", "fit", good, "--model", "he", "--surface", "wall"}, "expected ceiling or ground"},
        {{"aeromap", "fit", good, "--model", "he", "--source", "me"}, "expected jirs2024 or hydrus15_isolated"},
        {{"aeromap", "fit", good, "--model", "he", "--from", "5"}, "leave no measurement"},
        {{"aeromap", "fit", good, "--model", "he", "--fix", "b"}, "expected NAME=NUMBER"},
        {{"aeromap", "fit", good, "--model", "he", "--fix", "b=2x"}, "expected NAME=NUMBER"},
        {{"aeromap", "fit", good, "--model", "he", "--fix", "c=2"}, "no parameter 'c'"},
        {{"aeromap", "fit", good, "--model", "he", "--weighted"}, "line 5 has no sigma"},
        {{"aeromap", "fit", good, "--model", "he", "--rotor-spacing", "0"}, "expected radii, above 0"},
        {{"aeromap", "fit", good, "--model", "multirotor-body"}, "multirotor-body needs the other rotors"},
        {{"aeromap", "fit", good, "--model", "multirotor-images"}, "expected --rotor-spacing"},
        {{"aeromap", "compare", good, "--json", "--markdown"}, "expected at most one"},
    };
    for (const auto& [arguments, reason] : wrongs) {
        CAPTURE(arguments);
        const Result result = run(folder, arguments);
        CHECK(result.code == 2);
        CHECK(result.out.empty());
        CHECK_THAT(result.err, Catch::Contains(reason));
    }
}

TEST_CASE("A comparison lists every model for every source and surface") {
    const ScratchFolder folder;
    const auto sets = run(folder, {"aeromap", "compare", DOWNWASH_MEASUREMENTS, "--json"}).json().at("data_sets");
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

    const std::string markdown = run(folder, {"aeromap", "compare", DOWNWASH_MEASUREMENTS, "--markdown"}).out;
    CHECK_THAT(markdown, Catch::Contains("| `none` |  | 0.1171 | -0.206 |"));
    const std::string text = run(folder, {"aeromap", "compare", DOWNWASH_MEASUREMENTS}).out;
    CHECK_THAT(text, Catch::Contains("jirs2024, ceiling: 16 measurements, z/R 0.328 to 2.297\n"));
}

TEST_CASE("A comparison says for each surface what too high a K does, and a page shows it whole") {
    const ScratchFolder folder;
    const std::string markdown =
        run(folder, {"aeromap", "compare", DOWNWASH_MEASUREMENTS, "--rotor-spacing", "2.5", "--markdown"}).out;
    CHECK_THAT(markdown, Catch::Contains("Under a ceiling overstating is careful"));
    CHECK_THAT(markdown, Catch::Contains("Over the ground overstating is optimistic"));
    const std::string page = read_file(DOWNWASH_AEROMAP_PAGE);
    const std::string begin = "<!-- comparison -->\n";
    const auto first = page.find(begin);
    const auto last = page.find("<!-- /comparison -->\n");
    REQUIRE(first < last);
    REQUIRE(last != std::string::npos);
    CHECK(page.substr(first + begin.size(), last - first - begin.size()) == markdown);
}

TEST_CASE("A comparison without a column of surfaces takes all measurements at the surface that is asked for") {
    const ScratchFolder folder;
    write_file(folder / "m.csv", "z_over_r,thrust_ratio\n0.5,1.3\n1,1.1\n2,1.02\n");
    const auto models_of = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"aeromap", "compare", folder / "m.csv", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto sets = run(folder, arguments).json().at("data_sets");
        REQUIRE(sets.size() == 1);
        std::string names = sets[0].at("surface").get<std::string>() + ":";
        for (const auto& model : sets[0].at("models")) {
            names += " " + model.at("model").get<std::string>();
        }
        return names;
    };
    CHECK_THAT(models_of({}), Catch::Contains("cheeseman-bennett") && Catch::Contains("sanchez-cuevas"));
    CHECK_THAT(models_of({"--surface", "ceiling"}), Catch::StartsWith("ceiling: none sanchez-cuevas"));
    CHECK_THAT(models_of({"--surface", "ground"}), !Catch::Contains("sanchez-cuevas"));
    const Result misspelt = run(folder, {"aeromap", "compare", folder / "m.csv", "--surface", "cieling"});
    CHECK(misspelt.code == 2);
    CHECK_THAT(misspelt.err, Catch::Contains("did you mean 'ceiling'?"));
    write_file(folder / "m.csv", "z_over_r,thrust_ratio,surface\n0.5,1.3,grond\n");
    const Result in_file = run(folder, {"aeromap", "compare", folder / "m.csv"});
    CHECK(in_file.code == 2);
    CHECK_THAT(in_file.err, Catch::Contains("line 2") && Catch::Contains("did you mean 'ground'?"));
}
