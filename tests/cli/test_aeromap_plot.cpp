#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Matchers::Contains;

namespace {

constexpr char measurements[] =
    "# made up\n"
    "source,surface,z_over_r,thrust_ratio\n"
    "bench,ground,0.5,1.30\nbench,ground,0.5,1.34\nbench,ground,1,1.08\nbench,ceiling,1,1.1\n";

/// A command line that plots into `file` in the folder the program runs in.
std::vector<std::string> plot(const std::string& file, const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"aeromap", "plot", "-o", file};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
}

std::string picture_in(const ScratchFolder& folder, const std::string& file) {
    return read_file(folder.path() / "run" / file);
}

}  // namespace

TEST_CASE("The aero map of a problem is drawn with its obstacles") {
    const ScratchFolder folder;
    const Result result = run(folder, plot("bridge.svg", {problem_file("bridge_inspection")}));
    CHECK(result.code == 0);
    CHECK(result.out.empty());
    CHECK(result.err == "wrote bridge.svg\n");
    const std::string picture = picture_in(folder, "bridge.svg");
    for (const char* text :
         {"bridge_inspection: factor K on the thrust of rotor 1", "cheeseman-bennett", "sanchez-cuevas", "walkway",
          "pier", "left_girder, right_girder", "not flyable", ">1.05<"}) {
        INFO(text);
        CHECK(picture.find(text) != std::string::npos);
    }
    CHECK(picture.size() < 2'000'000);
    CHECK(files_in(folder.path() / "run").size() == 1);
}

TEST_CASE("One side, one rotor or place, and a part of the plane may be asked for") {
    const ScratchFolder folder;
    CHECK(run(folder, plot("a.svg", {problem_file("culvert"), "--what", "ceiling", "--lateral", "0", "--x", "2", "8",
                                     "--z", "0.5", "3", "--width", "600"}))
              .code == 0);
    const std::string picture = picture_in(folder, "a.svg");
    CHECK(picture.find("(ceiling only)") != std::string::npos);
    CHECK(picture.find("rotor hub in the plane of motion") != std::string::npos);
    CHECK(picture.find("cheeseman-bennett") == std::string::npos);
    CHECK(picture.find("cable_tray") != std::string::npos);
    CHECK(picture.find("width=\"600\"") != std::string::npos);
    const Result quiet =
        run(folder, plot("b.png", {problem_file("open_air"), "--rotor", "2", "--quiet", "--width", "400"}));
    CHECK(quiet.code == 0);
    CHECK(quiet.err.empty());
    CHECK(picture_in(folder, "b.png").substr(1, 3) == "PNG");
}

TEST_CASE("Where a vehicle can hover is drawn with the bounds of its problem") {
    const ScratchFolder folder;
    const std::vector<std::string> hold{
        problem_file("bridge_inspection"), "--what", "hold", "--arm-deg", "90", "--width", "600"};
    CHECK(run(folder, plot("hold.svg", hold)).code == 0);
    const std::string whole = picture_in(folder, "hold.svg");
    for (const char* text :
         {"unstable", "beyond the model", "stability boundary", "bounds of the problem", "dasharray"}) {
        INFO(text);
        CHECK(whole.find(text) != std::string::npos);
    }
}

TEST_CASE("Force and torque on the whole vehicle are drawn at a pitch, with what a torque is divided by") {
    const ScratchFolder folder;
    const auto picture_of = [&](const std::string& what, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{problem_file("bridge_inspection"), "--what", what, "--width", "600"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        CHECK(run(folder, plot(what + ".svg", arguments)).code == 0);
        return picture_in(folder, what + ".svg");
    };
    const std::string level = picture_of("force", {});
    CHECK_THAT(level, Contains("bridge_inspection, ars_lrm, level"));
    const std::string tilted = picture_of("force", {"--pitch-deg", "-20"});
    CHECK_THAT(tilted, Contains("pitched 20 degrees nose up"));
    // What is drawn differs, not only what is written over it.
    CHECK(std::count(level.begin(), level.end(), '\n') != std::count(tilted.begin(), tilted.end(), '\n'));
    // 4.95 kg times 9.80665 m/s2 times 0.1905 m.
    const std::string torque = picture_of("torque", {"--pitch-deg", "12.5"});
    CHECK_THAT(torque, Contains("pitched 12.5 degrees nose down; its factor is that over m g R = 9.247 Nm"));
    CHECK_THAT(torque, Contains("pitch torque [Nm]"));
}

TEST_CASE("Curves of models are drawn with measurements, repeated ones as mean and deviation") {
    const ScratchFolder folder;
    write_file(folder.path() / "run" / "data.csv", measurements);
    CHECK(run(folder, plot("k.svg", {"--model", "cheeseman-bennett", "he", "--data", "data.csv"})).code == 0);
    const std::string picture = picture_in(folder, "k.svg");
    for (const char* text :
         {"cheeseman-bennett", ">he<", "bench, ground (mean and standard deviation)", "bench, ceiling"}) {
        INFO(text);
        CHECK(picture.find(text) != std::string::npos);
    }
    CHECK(run(folder, plot("d.svg", {"--data", "data.csv", "--surface", "ceiling", "--z-over-r", "0.5", "2"})).code ==
          0);
    CHECK(picture_in(folder, "d.svg").find("bench, ground") == std::string::npos);
}

TEST_CASE("The flow of a rotor and its image is drawn") {
    const ScratchFolder folder;
    CHECK(run(folder, plot("flow.svg", {"--flow", "--z-over-r", "1.5", "--width", "500"})).code == 0);
    const std::string picture = picture_in(folder, "flow.svg");
    CHECK(picture.find("z/R = 1.5") != std::string::npos);
    CHECK(picture.find("image of the rotor") != std::string::npos);
}

TEST_CASE("The same command gives the same picture") {
    const ScratchFolder folder;
    for (const char* file : {"1.png", "2.png"}) {
        CHECK(run(folder, plot(file, {problem_file("open_air"), "--width", "500"})).code == 0);
    }
    CHECK(picture_in(folder, "1.png") == picture_in(folder, "2.png"));
}

TEST_CASE("What cannot be plotted is refused with a remedy, and leaves no file") {
    const ScratchFolder folder;
    write_file(folder.path() / "run" / "data.csv", measurements);
    const std::string problem = problem_file("open_air");
    const struct {
        std::vector<std::string> arguments;
        const char* words;
    } cases[] = {
        {plot("a.bmp", {problem}), "ends in .svg, .png or .pdf"},
        {plot("no-such-folder/a.svg", {problem}), "no-such-folder/a.svg"},
        {plot("a.svg", {}), "wants one of PROBLEM"},
        {plot("a.svg", {problem, "--flow", "--z-over-r", "1"}), "wants one of PROBLEM"},
        {plot("a.svg", {problem, "--what", "facter"}), "factor"},
        {plot("a.svg", {problem, "--rotor", "0"}), "--rotor 0"},
        {plot("a.svg", {problem, "--rotor", "99"}), "--rotor 99"},
        {plot("a.svg", {problem, "--lateral", "nan"}), "--lateral"},
        {plot("a.svg", {problem, "--x", "2", "2"}), "--x 2 2"},
        {plot("a.svg", {problem, "--z", "1", "1e9"}), "--z 1"},
        {plot("a.svg", {problem, "--x", "0", "1000", "--z", "0", "1"}), "40 times"},
        {plot("a.svg", {problem, "--width", "20"}), "--width 20"},
        {plot("a.svg", {problem, "--arm-deg", "90"}),
         "--arm-deg changes nothing in this picture: it goes with PROBLEM"},
        {plot("a.svg", {problem, "--what", "hold", "--rotor", "2"}), "--rotor changes nothing"},
        {plot("a.svg", {problem, "--what", "force", "--lateral", "0"}), "--lateral changes nothing"},
        {plot("a.svg", {problem, "--what", "hold", "--pitch-deg", "5"}),
         "--pitch-deg changes nothing in this picture: it goes with PROBLEM and --what force or torque"},
        {plot("a.svg", {problem, "--what", "force", "--pitch-deg", "81"}), "--pitch-deg 81: expected degrees"},
        {plot("a.svg", {problem, "--max-factor", "3"}), "it goes with --model"},
        {plot("a.svg", {problem, "--z-over-r", "1", "2"}), "--model, --data or --flow"},
        {plot("a.svg", {"--model", "he", "--what", "factor"}), "--what changes nothing"},
        {plot("a.svg", {"--model", "he", "--x", "0", "1"}), "--x changes nothing"},
        {plot("a.svg", {"--model", "he", "--surface", "ground"}), "it goes with --data"},
        {plot("a.svg", {"--model", "he", "--rotor-spacing", "3"}), "multirotor-images or multirotor-body"},
        {plot("a.svg", {"--data", "data.csv", "--max-factor", "3"}), "it goes with --model"},
        {plot("a.svg", {"--flow", "--z-over-r", "1", "--source", "me"}), "--source changes nothing"},
        {plot("a.svg", {"--data", "data.csv", "--surface", "grund"}), "did you mean 'ground'?"},
        {plot("a.svg", {"--model", "no-such-model"}), "no-such-model"},
        {plot("a.svg", {"--model", "table"}), "no curve of its own"},
        {plot("a.svg", {"--model", "he", "--z-over-r", "3", "1"}), "--z-over-r 3 1"},
        {plot("a.svg", {"--model", "he", "--max-factor", "0.5"}), "--max-factor 0.5"},
        {plot("a.svg", {"--data", "data.csv", "--surface", "wall"}), "ground"},
        {plot("a.svg", {"--data", "data.csv", "--z-over-r", "5", "6"}), "no measurement"},
        {plot("a.svg", {"--data", "absent.csv"}), "absent.csv"},
        {plot("a.svg", {"--flow"}), "--z-over-r H"},
        {plot("a.svg", {"--flow", "--z-over-r", "0"}), "--z-over-r H"},
    };
    for (const auto& [arguments, words] : cases) {
        const Result result = run(folder, arguments);
        INFO(result.err);
        CHECK(result.code == 2);
        CHECK(result.out.empty());
        CHECK_THAT(result.err, Contains(words));
    }
    CHECK(files_in(folder.path() / "run").size() == 1);
}

TEST_CASE("Without gnuplot a plot ends with the name of the package to install") {
    const ScratchFolder folder;
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder.path().c_str(), 1);
    const Result result = run(folder, plot("a.svg", {"--flow", "--z-over-r", "1"}));
    setenv("PATH", path.c_str(), 1);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains("gnuplot-nox"));
    CHECK(files_in(folder.path() / "run").empty());
}

TEST_CASE("A file's name that would be a command is a name") {
    const ScratchFolder folder;
    const std::string name = "'; system('touch here'); '`touch here`.svg";
    CHECK(run(folder, plot(name, {"--flow", "--z-over-r", "1", "--width", "400"})).code == 0);
    const auto files = files_in(folder.path() / "run");
    REQUIRE(files.size() == 1);
    CHECK(files.begin()->first == name);
}

TEST_CASE("Curves are dotted where their models were not shown to hold") {
    const ScratchFolder folder;
    CHECK(run(folder, plot("k.svg", {"--model", "he", "--z-over-r", "0.1", "3"})).code == 0);
    CHECK_THAT(picture_in(folder, "k.svg"), Contains("where the model was not shown to hold"));
    CHECK(run(folder, plot("k.svg", {"--model", "he", "--z-over-r", "0.3", "3"})).code == 0);
    CHECK_THAT(picture_in(folder, "k.svg"), !Contains("not shown to hold"));
}

TEST_CASE("Outside a given map a picture is hatched, and says what that means") {
    const ScratchFolder folder;
    std::string text = read_file(problem_file("open_air"));
    const std::string robot = "robots/ars_lrm.yaml";
    const std::string shipped = problem_file("open_air");
    text.replace(text.find(robot), robot.size(), shipped.substr(0, shipped.rfind('/') + 1) + robot);
    write_file(folder / "map.csv", "x_m,z_m,factor\n-20,-20,1.1\n20,-20,1.1\n-20,20,1\n20,20,1\n");
    write_file(folder / "problem.yaml", text + "aero: {map: map.csv}\n");
    for (const char* what : {"factor", "force"}) {
        const Result result = run(folder, plot("a.svg", {folder / "problem.yaml", "--what", what, "--x", "-30", "30",
                                                         "--z", "-15", "25", "--width", "500"}));
        CAPTURE(result.err);
        REQUIRE(result.code == 0);
        CHECK_THAT(picture_in(folder, "a.svg"),
                   Contains("not flyable, or outside the given map") && Contains("<pattern"));
    }
}
