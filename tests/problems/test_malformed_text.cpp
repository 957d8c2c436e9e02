#include <algorithm>

#include "downwash/problems/text_checks.hpp"
#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

std::string errors_of_text(std::string_view text) {
    return TestFolder().errors_of(text, good_robot);
}

std::string repeated(std::string_view text, int times) {
    std::string out;
    for (int i = 0; i < times; ++i) {
        out += text;
    }
    return out;
}

const std::string no_yaml = "): expected 'key: value' with matching brackets, quotes and indentation";

}  // namespace

TEST_CASE("a file that is no single YAML document of keys is an error") {
    const std::string good(good_problem);
    for (const char* text : {"", "# nothing\n\n"}) {
        CHECK(errors_of_text(text) == "problem.yaml:1:1: is empty: expected a YAML document with keys");
    }
    CHECK(errors_of_text("- schema\n- name\n") == "problem.yaml:1:1: is a list: expected a file of keys and values");
    CHECK(errors_of_text("a problem\n") == "problem.yaml:1:1: is 'a problem': expected a file of keys and values");
    CHECK(errors_of_text(good + "---\nname: second\n") ==
          "problem.yaml:18:1: a second document begins: expected only one");
    CHECK(errors_of_text(good + "description: |\n  several\n  lines\n") == "sound");
    for (const std::string& text : {std::string("name: [1, 2\nstart: 3\n"), good + "description: \"open\n",
                                    good + "description: 'open\n", good + "}\n"}) {
        CHECK(errors_of_text(text).ends_with(no_yaml));
    }
}

TEST_CASE("UTF-16 is called by its name") {
    const std::string text = "schema: downwash/problem/v1\nname: wide\n";
    for (const bool is_little : {true, false}) {
        std::string wide;
        for (const char letter : text) {
            wide += is_little ? std::string{letter, '\0'} : std::string{'\0', letter};
        }
        const std::string mark = is_little ? "\xFF\xFE" : "\xFE\xFF";
        for (const std::string& bytes : {wide, mark + wide}) {
            CHECK(errors_of_text(bytes) ==
                  "problem.yaml:1:1: is UTF-16 text: expected YAML in UTF-8; save it in that encoding");
        }
    }
}

TEST_CASE("bytes that are no text are errors at their place") {
    using namespace std::string_literals;
    CHECK(errors_of_text("name: a\nstart: \0x"s) ==
          "problem.yaml:2:8: holds bytes that are no text: expected YAML in UTF-8");
    for (const char* text : {"name: \xff\xfe\n", "name: \xc0\xaf\n", "name: \xed\xa0\x80\n"}) {
        CHECK(errors_of_text(text) == "problem.yaml:1:7: holds bytes that are no text: expected YAML in UTF-8");
    }
    CHECK(errors_of_text("\x7f"
                         "ELF\x02\x01\x01") ==
          "problem.yaml:1:5: holds bytes that are no text: expected YAML in UTF-8");
    CHECK(errors_of_text("start:\n\tx_m: 1\n") == "problem.yaml:2:1: a tab in the indentation: expected spaces");
}

TEST_CASE("lines may end in any way") {
    std::string good(good_problem);
    for (const char* end : {"\r\n", "\r"}) {
        std::string text;
        for (const char c : good) {
            text += c == '\n' ? end : std::string(1, c);
        }
        CHECK(errors_of_text(text) == "sound");
        CHECK(errors_of_text("# by hand" + std::string(end) + text) == "sound");
        // The line of an error is the same.
        CHECK(errors_of_text(text + "wrong: 1" + end) == errors_of_text(good + "wrong: 1\n"));
    }
}

TEST_CASE("merge keys are named as what is not read, and hide no other error") {
    const std::string merged = edited(good_problem, "start: {", "start: {<<: {x_m: 1}, ");
    CHECK(
        errors_of_text(merged) ==
        "problem.yaml:12:9: merge keys (<<) are not read: expected the keys themselves; an alias (*name) may stand for "
        "a whole value");
    // What it would have brought is not missing.
    const std::string brought =
        edited(good_problem, "box: {size_m: [30, 20, 1], ", "box: {<<: {size_m: [30, 20, 1]}, ");
    CHECK(errors_of_text(brought).find("missing") == std::string::npos);
    CHECK(errors_of_text(brought).find("merge keys (<<) are not read") != std::string::npos);
}

TEST_CASE("files that cannot be read are errors") {
    const TestFolder folder;
    CHECK(folder.errors_of("missing.yaml") == "missing.yaml:1:1: cannot be read: there is no such file");
    std::filesystem::create_directory(folder / "folder.yaml");
    CHECK(folder.errors_of("folder.yaml") == "folder.yaml:1:1: cannot be read: it is a directory, expected a file");
    folder.write("problem.yaml", edited(good_problem, "robot.yaml", "folder.yaml"));
    CHECK(folder.errors_of("problem.yaml") ==
          "problem.yaml:3:8: robot 'folder.yaml' cannot be read: it is a directory, expected a file");
    folder.write("large.yaml", std::string(problems::largest_document + 1, ' '));
    CHECK(folder.errors_of("large.yaml") ==
          "large.yaml:1:1: is larger than 32768 KiB: expected a problem or robot file");
    folder.write("crowded.yaml", "[" + repeated("1,", 2600000) + "1]");
    CHECK(folder.errors_of("crowded.yaml") ==
          "crowded.yaml:1:1: has more than 2500000 line breaks, commas, colons and brackets: expected a problem or "
          "robot file");
    CHECK_THROWS_AS(read_problem("/dev/zero"), ProblemFileError);
}

TEST_CASE("no file makes the reader crash, hang or eat memory") {
    for (const std::string_view piece :
         {"[", "{", "- ", "? ", ": ",   ",",    "!",    "&a ",  "*a ",          "\"",    "'",    "|",
          ">", "%", "@",  "`",  "[[],", "{a: ", "a:\n", "- - ", "a: &a [*a]\n", "---\n", "...\n"}) {
        CAPTURE(piece);
        CHECK(errors_of_text(repeated(piece, 1000000 / static_cast<int>(piece.size()))) != "sound");
    }
    std::string stairs;
    for (int i = 0; i < 1000; ++i) {
        stairs += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
    }
    CHECK(errors_of_text(stairs).find("is nested deeper than 32 levels") != std::string::npos);
}

TEST_CASE("aliases are understood, but not those that never end or explode") {
    const std::string good(good_problem);
    CHECK(errors_of_text(edited(edited(good, "[30, 20, 1]", "&size [30, 20, 1]"),
                                "cylinder: {radius_m: 0.2, length_m: 5, center_m",
                                "box: {size_m: *size, center_m: [4, 30, -0.5], rpy_deg")) == "sound");
    CHECK(errors_of_text("start: &loop {x_m: *loop}\n") ==
          "problem.yaml:1:20: an alias refers to a value that it is part of: write the value out");
    CHECK(errors_of_text("start: *nowhere\n") ==
          "problem.yaml:1:8: cannot be read as YAML (the referenced anchor is not "
          "defined" +
              no_yaml);
    std::string bomb = "a0: &a0 [1, 2]\n";
    std::string chain = "a0: &a0 [1]\n";
    for (int i = 1; i < 100; ++i) {
        const std::string begin = "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
        const std::string last = "*a" + std::to_string(i - 1);
        chain.append(begin).append(last).append("]\n");
        if (i < 30) {
            bomb.append(begin).append(last).append(", ").append(last).append(", ").append(last).append("]\n");
        }
    }
    CHECK(errors_of_text(edited(good, "obstacles:\n", "obstacles: *a29\n") + bomb) != "sound");
    CHECK(errors_of_text(bomb + good) != "sound");
    CHECK(errors_of_text(chain + good).find("is nested deeper than 32 levels") != std::string::npos);
}

TEST_CASE("a file full of errors is not read to the end") {
    const std::string errors = errors_of_text(std::string(good_problem) + repeated("wrong: 1\n", 100000));
    CHECK(std::count(errors.begin(), errors.end(), '\n') == 99);
}

TEST_CASE("a file of another program is told as what it is, with what to do instead") {
    CHECK_THAT(errors_of_text("<?xml version=\"1.0\"?>\n<robot name=\"hexa\">\n<link/></robot>\n"),
               StartsWith("problem.yaml:1:1: is a robot in URDF: expected a robot file in YAML (") &&
                   Contains("multirotor.pitch_inertia_kg_m2") && Contains("docs/robot_files.md"));
    CHECK_THAT(errors_of_text("<sdf version='1.9'/>"), StartsWith("problem.yaml:1:1: is a robot in SDF: "));
    CHECK(errors_of_text("<svg/>") == "problem.yaml:1:1: is XML: expected YAML");
    CHECK_THAT(
        errors_of_text("solid x\n facet normal 0 0 1\n"),
        StartsWith("problem.yaml:1:1: is a mesh: expected YAML; a mesh (.stl or .obj) stands in a problem file"));
    CHECK(errors_of_text("z_over_r,factor\n1,1.1\n") == "problem.yaml:1:1: is a table: expected YAML");
    CHECK_THAT(errors_of_text("throttle_pct;Thrust_g;power_w\n20;330;30\n"),
               Contains("rotors.max_thrust_n") && Contains("rotors.power_coefficient_w_n1p5"));
}

TEST_CASE("a file that stands for the robot is named with the line that names it") {
    const TestFolder folder;
    folder.write("problem.yaml", good_problem);
    folder.write("robot.yaml", "thrust_g,power_w\n330,30\n");
    const std::string table = folder.errors_in([&] { return read_problem(folder / "problem.yaml"); });
    CHECK_THAT(table, StartsWith("robot.yaml:1:1: is a table: expected YAML; a thrust stand gives") &&
                          EndsWith("problem.yaml:3 takes it for the robot"));
    folder.write("robot.yaml", "- mass\n");
    CHECK_THAT(folder.errors_in([&] { return read_problem(folder / "problem.yaml"); }),
               StartsWith("robot.yaml:1:1: is a list: expected a file of keys and values; ") &&
                   EndsWith("problem.yaml:3 takes it for the robot"));
}

TEST_CASE("a decimal comma is named") {
    CHECK(errors_of_text(edited(good_problem, "z_m: 2.5, tolerance_m", "z_m: 2,5, tolerance_m")) ==
          "problem.yaml:14:33: unknown key '5': numbers have a decimal point; write z_m: 2.5");
    CHECK_THAT(errors_of_text(edited(good_problem, "hold_s: 5", "hold_s: 5,5")),
               Contains("goal.hold_s is '5,5': expected") && Contains("; numbers have a decimal point: 5.5"));
}
