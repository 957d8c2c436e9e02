#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Matchers::Contains;

namespace {

constexpr char measurements[] =
    "# made up\n"
    "source,surface,z_over_r,thrust_ratio\n"
    "bench,ground,0.5,1.30\nbench,ground,0.5,1.34\nbench,ground,1,1.08\nbench,ceiling,1,1.1\n";

/// What is drawn by options of `aeromap plot`.
template <class... Parts>
std::string plotted(const Workspace& work, const std::string& file, const Parts&... options) {
    work.succeed("aeromap plot -o", file, options...);
    return work.text(file);
}

}  // namespace

TEST_CASE("The aero map of a problem is drawn with its obstacles") {
    const Workspace work;
    const Result result = work.succeed("aeromap plot -o bridge.svg", problem_file("bridge_inspection"));
    CHECK(result.out.empty());
    CHECK(result.err == "wrote bridge.svg\n");
    const std::string picture = work.text("bridge.svg");
    CHECK_THAT(picture, Contains("bridge_inspection: factor K on the thrust of rotor 1") &&
                            Contains("cheeseman-bennett") && Contains("sanchez-cuevas") && Contains("walkway") &&
                            Contains("pier") && Contains("left_girder, right_girder") && Contains("not flyable") &&
                            Contains(">1.05<"));
    CHECK(picture.size() < 2'000'000);
    CHECK(work.files().size() == 1);
    CHECK_THAT(plotted(work, "bare.svg", problem_file("bridge_inspection"), "--no-labels"),
               !Contains("walkway") && Contains("not flyable"));
}

TEST_CASE("One side, one rotor or place, and a part of the plane may be asked for") {
    const Workspace work;
    const std::string picture =
        plotted(work, "a.svg", problem_file("culvert"), "--what ceiling --lateral 0 --x 2 8 --z 0.5 3 --width 600");
    CHECK_THAT(picture, Contains("(ceiling only)") && Contains("rotor hub in the plane of motion") &&
                            !Contains("cheeseman-bennett") && Contains("cable_tray") && Contains("width=\"600\""));
    const Words quietly = words("aeromap plot", problem_file("open_air"), "--rotor 2 --quiet --width 400 -o");
    CHECK(work.succeed(quietly, "b.png").err.empty());
    CHECK(work.text("b.png").substr(1, 3) == "PNG");
    work.succeed(quietly, "same.png");
    CHECK(work.text("same.png") == work.text("b.png"));
}

TEST_CASE("Where a vehicle can hover is drawn with the bounds of its problem, what is outside a given map is hatched") {
    const Workspace work;
    const std::string whole =
        plotted(work, "hold.svg", problem_file("bridge_inspection"), "--what hold --arm-deg 90 --width 600");
    CHECK_THAT(whole, Contains("unstable") && Contains("beyond the model") && Contains("stability boundary") &&
                          Contains("bounds of the problem") && Contains("dasharray"));
    write_file(work / "map.csv", "x_m,z_m,factor\n-20,-20,1.1\n20,-20,1.1\n-20,20,1\n20,20,1\n");
    write_file(work / "problem.yaml", problem_text("open_air") + "aero: {map: map.csv}\n");
    for (const char* what : {"factor", "force"}) {
        CHECK_THAT(plotted(work, "a.svg", work / "problem.yaml", "--x -30 30 --z -15 25 --width 500 --what", what),
                   Contains("not flyable, or outside the given map") && Contains("<pattern"));
    }
}

TEST_CASE("Force and torque on the whole vehicle are drawn at a pitch, with what a torque is divided by") {
    const Workspace work;
    const auto picture_of = [&](const char* options) {
        return plotted(work, "a.svg", shipped_file("bridge_inspection"), "--width 600 --what", options);
    };
    const std::string level = picture_of("force");
    CHECK_THAT(level, Contains("bridge_inspection, ars_lrm, level"));
    const std::string tilted = picture_of("force --pitch-deg -20");
    CHECK_THAT(tilted, Contains("pitched 20 degrees nose up"));
    // What is drawn differs, not only what is written over it.
    CHECK(std::count(level.begin(), level.end(), '\n') != std::count(tilted.begin(), tilted.end(), '\n'));
    // 4.95 kg times 9.80665 m/s2 times 0.1905 m.
    CHECK_THAT(picture_of("torque --pitch-deg 12.5"),
               Contains("pitched 12.5 degrees nose down; its factor is that over m g R = 9.247 Nm") &&
                   Contains("pitch torque [Nm]"));
}

TEST_CASE("Curves of models are drawn with measurements, repeated ones as mean and deviation") {
    const Workspace work;
    write_file(work.in_run("data.csv"), measurements);
    CHECK_THAT(plotted(work, "k.svg", "--model cheeseman-bennett he --data data.csv"),
               Contains("cheeseman-bennett") && Contains(">he<") &&
                   Contains("bench, ground (mean and standard deviation)") && Contains("bench, ceiling"));
    CHECK_THAT(plotted(work, "d.svg", "--data data.csv --surface ceiling --z-over-r 0.5 2"),
               !Contains("bench, ground"));
    // They are dotted where their models were not shown to hold.
    CHECK_THAT(plotted(work, "k.svg", "--model he --z-over-r 0.1 3"),
               Contains("where the model was not shown to hold"));
    CHECK_THAT(plotted(work, "k.svg", "--model he --z-over-r 0.3 3"), !Contains("not shown to hold"));
}

TEST_CASE("What cannot be plotted is rejected with a remedy, and leaves no file") {
    const Workspace work;
    write_file(work.in_run("data.csv"), measurements);
    const auto check = [&](const Words& arguments, const std::string& reason) {
        CAPTURE(arguments);
        check_rejected(work.run("aeromap plot", arguments), reason);
    };
    for (const auto& [arguments, reason] : {
             std::pair{"a.bmp", "ends in .svg, .png or .pdf"},
             {"no-such-folder/a.svg", "no-such-folder/a.svg"},
             {"a.svg --flow --z-over-r 1", "needs one of PROBLEM"},
             {"a.svg --what facter", "factor"},
             {"a.svg --rotor 0", "--rotor 0"},
             {"a.svg --rotor 99", "--rotor 99"},
             {"a.svg --lateral nan", "--lateral"},
             {"a.svg --x 2 2", "--x 2 2"},
             {"a.svg --z 1 1e9", "--z 1"},
             {"a.svg --x 0 1000 --z 0 1", "40 times"},
             {"a.svg --width 20", "--width is '20': expected 400 to 8000; "},
             {"a.svg --arm-deg 90", "--arm-deg changes nothing in this picture: it goes with PROBLEM"},
             {"a.svg --what hold --rotor 2", "--rotor changes nothing"},
             {"a.svg --what force --lateral 0", "--lateral changes nothing"},
             {"a.svg --what hold --pitch-deg 5",
              "--pitch-deg changes nothing in this picture: it goes with PROBLEM and --what force or torque"},
             {"a.svg --what force --pitch-deg 81", "--pitch-deg 81: expected degrees"},
             {"a.svg --max-factor 3", "it goes with --model"},
             {"a.svg --z-over-r 1 2", "--model, --data or --flow"},
         }) {
        check(words(problem_file("open_air"), "-o", arguments), reason);
    }
    for (const auto& [arguments, reason] : {
             std::pair{"", "needs one of PROBLEM"},
             {"--model he --what factor", "--what changes nothing"},
             {"--model he --x 0 1", "--x changes nothing"},
             {"--model he --no-labels", "--no-labels changes nothing"},
             {"--model he --surface ground", "it goes with --data"},
             {"--model he --rotor-spacing 3", "multirotor-images or multirotor-body"},
             {"--data data.csv --max-factor 3", "it goes with --model"},
             {"--flow --z-over-r 1 --source me", "--source changes nothing"},
             {"--data data.csv --surface grund", "did you mean 'ground'?"},
             {"--model no-such-model", "no-such-model"},
             {"--model table", "no curve of its own"},
             {"--model he --z-over-r 3 1", "--z-over-r 3 1"},
             {"--model he --max-factor 0.5", "--max-factor 0.5"},
             {"--data data.csv --surface wall", "ground"},
             {"--data data.csv --z-over-r 5 6", "no measurement"},
             {"--data absent.csv", "absent.csv"},
             {"--flow", "--z-over-r H"},
             {"--flow --z-over-r 0", "--z-over-r H"},
         }) {
        check(words("-o a.svg", arguments), reason);
    }
    CHECK(work.files().size() == 1);
    // Without gnuplot it names the package to install.
    check_rejected(
        work.run_in({{"PATH", work.path().string()}}, "", words("aeromap plot -o a.svg --flow --z-over-r 1")),
        "gnuplot-nox");
}

TEST_CASE("The flow of a rotor and its image is drawn, into a file whose name would be a command") {
    const Workspace work;
    const std::string name = "'; system('touch here'); '`touch here`.svg";
    CHECK_THAT(plotted(work, name, "--flow --z-over-r 1.5 --width 500"),
               Contains("z/R = 1.5") && Contains("image of the rotor"));
    const auto files = work.files();
    REQUIRE(files.size() == 1);
    CHECK(files.begin()->first == name);
}
