#include <algorithm>
#include <cstdio>

#include "../support/error_of.hpp"
#include "../support/mesh_bytes.hpp"
#include "../support/random.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr std::string_view pole = "cylinder: {radius_m: 0.2, length_m: 5, center_m: [4, 3, 2.5]}";

/// The lowest of the eight children of the root is occupied: a cube of 3276.8 m below the origin.
const std::string cube_bt =
    std::string("# Octomap OcTree binary file\nid OcTree\nsize 2\nres 0.1\ndata\n") + std::string("\x02\x00", 2);

std::string ascii_stl(const std::vector<Triangle>& triangles) {
    std::string text = "solid\n";
    for (const Triangle& triangle : triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const Vector3& v : triangle) {
            text += "vertex " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
}

/// The sound problem with another shape in place of its pole.
Problem read_with(const TestFolder& folder, std::string_view shape) {
    return folder.read(edited(good_problem, pole, shape));
}

std::string errors_with(const TestFolder& folder, std::string_view shape) {
    return errors_after(folder, pole, shape);
}

const std::vector<Triangle>& pole_triangles() {
    static const auto triangles = box_triangles({3.5, 2.5, 0}, {4.5, 3.5, 5});
    return triangles;
}

}  // namespace

TEST_CASE("a mesh is read from beside its problem and keeps its place and scale") {
    const TestFolder folder;
    std::filesystem::create_directory(folder / "meshes");
    folder.write("meshes/pole.stl", binary_stl(pole_triangles()));
    const Problem problem =
        read_with(folder, "mesh: {file: meshes/pole.stl, scale: 0.5, center_m: [0, 1, 2], rpy_deg: [0, 0, 90]}");
    const Obstacle& obstacle = problem.obstacles.at(1);
    const auto& mesh = std::get<Mesh>(obstacle.shape);
    CHECK(mesh.file == (folder / "meshes/pole.stl").string());
    CHECK(mesh.scale == 0.5);
    CHECK(mesh.surface->triangles.size() == 12);
    CHECK(mesh.surface->vertices_m[0] == pole_triangles()[0][0]);
    CHECK(obstacle.center_world_m == Vector3{0, 1, 2});
    CHECK(obstacle.rpy_rad == Vector3{0, 0, 1.5707963267948966});
}

TEST_CASE("an octree is read from beside its problem, at the origin unless placed") {
    const TestFolder folder;
    folder.write("scan.bt", cube_bt);
    const Problem problem = read_with(folder, "octomap: {file: scan.bt, center_m: [0, 0, -50]}");
    const auto& octomap = std::get<Octomap>(problem.obstacles.at(1).shape);
    CHECK(octomap.tree->resolution_m == 0.1);
    REQUIRE(octomap.tree->cubes.size() == 1);
    CHECK(octomap.tree->cubes[0].side_m == 32768 * 0.1);
    CHECK(octomap.tree->cubes[0].center_local_m == Vector3{-16384 * 0.1, -16384 * 0.1, -16384 * 0.1});
    CHECK(problem.obstacles[1].center_world_m == Vector3{0, 0, -50});
    folder.write("pole.stl", binary_stl(pole_triangles()));
    const Problem plain = read_with(folder, "mesh: {file: pole.stl}");
    CHECK(plain.obstacles.at(1).center_world_m == Vector3{});
    CHECK(plain.obstacles[1].rpy_rad == Vector3{});
    CHECK(std::get<Mesh>(plain.obstacles[1].shape).scale == 1);
    // A file that is placed twice is read once.
    const Problem twice =
        read_with(folder, "mesh: {file: pole.stl}}\n    - {name: other, mesh: {file: pole.stl, center_m: [1, 1, 0]}");
    CHECK(std::get<Mesh>(twice.obstacles.at(1).shape).surface == std::get<Mesh>(twice.obstacles.at(2).shape).surface);
}

TEST_CASE("errors of a foreign file stand where the problem names it, with their place in it") {
    const TestFolder folder;
    folder.write("bad.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n");
    CHECK(errors_with(folder, "mesh: {file: bad.stl}") ==
          "problem.yaml:8:33: environment.obstacles[1].mesh.file 'bad.stl' line 4: found 'nan', expected a finite "
          "number of at most 1e10 in size");
    folder.write("bad.stl", binary_stl(pole_triangles()).substr(0, 600));
    CHECK(errors_with(folder, "mesh: {scale: 2, file: bad.stl}") ==
          "problem.yaml:8:43: environment.obstacles[1].mesh.file 'bad.stl' byte 80: says 12 triangles, expected 84 + "
          "50 times as many bytes, 684, found 600");
    folder.write("bad.bt", cube_bt + "x");
    CHECK(
        errors_with(folder, "octomap: {file: bad.bt}") ==
        "problem.yaml:8:36: environment.obstacles[1].octomap.file 'bad.bt' byte 61: the file continues after its last "
        "node: expected its end");
    CHECK(errors_with(folder, "mesh: {file: ''}") ==
          "problem.yaml:8:33: environment.obstacles[1].mesh.file '' cannot be read: it is a directory, expected a "
          "file");
    CHECK(errors_with(folder, "mesh: {file: [a.stl]}") ==
          "problem.yaml:8:33: environment.obstacles[1].mesh.file is a list: expected the path of a file");
    CHECK(errors_with(folder, "mesh: {scale: 2}") ==
          "problem.yaml:8:20: environment.obstacles[1].mesh.file is missing: expected the path of a file");
    CHECK(errors_with(folder, "octomap: {file: pole.bt, scale: 2}") ==
          "problem.yaml:8:36: environment.obstacles[1].octomap.file 'pole.bt' cannot be read: there is no such file\n"
          "problem.yaml:8:45: unknown key 'scale' in environment.obstacles[1].octomap: expected file, unknown, "
          "center_m or "
          "rpy_deg");
}

TEST_CASE("surfaces that cannot be placed are errors at their obstacle") {
    const TestFolder folder;
    folder.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    CHECK_THAT(errors_with(folder, "mesh: {file: line.obj}"),
               Catch::StartsWith("problem.yaml:8:") && Catch::Contains("area"));
    folder.write("pole.stl", binary_stl(pole_triangles()));
    CHECK_THAT(errors_with(folder, "mesh: {file: pole.stl, scale: 1e6}"),
               Catch::StartsWith("problem.yaml:8:33: environment.obstacles[1].mesh.file '") &&
                   Catch::Contains("pole.stl' has the corner [3.5, ") &&
                   Catch::EndsWith("], which is not finite or, once scaled, farther than 1e6 m from its origin"));
    // What no triangle has does not matter.
    folder.write("more.obj", "v 3 3 0\nv 4 3 0\nv 3 4 0\nv 1e9 0 0\nf 1 2 3\n");
    CHECK(errors_with(folder, "mesh: {file: more.obj}") == "sound");
    CHECK(errors_with(folder, "mesh: {file: pole.stl, scale: 0}") ==
          "problem.yaml:8:50: environment.obstacles[1].mesh.scale is 0: expected a number from 1e-06 to 1000000");
    // Bodies of a robot are no meshes.
    CHECK(errors_after_robot(folder, "box: {size_m: [1, 1, 0.2], center_m: [0, 0, 0]}", "mesh: {file: a.stl}") ==
          "robot.yaml:7:7: unknown key 'mesh' in multirotor.body[0]: expected box, cylinder or sphere\n"
          "robot.yaml:7:7: multirotor.body[0] needs exactly one of box, cylinder or sphere");
}

TEST_CASE("more triangles than a scene holds are not even kept") {
    const TestFolder folder;
    std::string fan = "v 0 100 0\nv 1 100 0\nv 0 101 0\n";
    for (int i = 0; i < 1'200'000; ++i) {
        fan += "f 1 2 3\n";
    }
    folder.write("fan.obj", fan);
    CHECK(errors_with(folder, "mesh: {file: fan.obj}}\n    - {name: other, mesh: {file: fan.obj}") ==
          "problem.yaml:9:34: environment.obstacles[2].mesh.file 'fan.obj' makes 2400000 triangles and cubes of all "
          "obstacles: expected at most 2000000");
}

namespace {

/// What reading the sound problem with another shape in place of its pole warns of.
std::vector<std::string> warnings_with(const TestFolder& folder, std::string_view shape) {
    folder.write("problem.yaml", edited(good_problem, pole, shape));
    folder.write("robot.yaml", good_robot);
    std::vector<std::string> warnings;
    static_cast<void>(read_problem(folder / "problem.yaml", {}, {}, [&](const LocatedError& warning) {
        warnings.push_back(std::to_string(warning.line) + ": " + warning.message);
    }));
    return warnings;
}

/// Only those about the shape.
std::vector<std::string> shape_warnings(const TestFolder& folder, std::string_view shape) {
    std::vector<std::string> all = warnings_with(folder, shape);
    std::erase_if(all, [](const std::string& text) { return text.find("environment.obstacles") == std::string::npos; });
    return all;
}

std::vector<Triangle> scaled(std::vector<Triangle> triangles, double scale, const Vector3& offset) {
    for (Triangle& triangle : triangles) {
        for (Vector3& corner : triangle) {
            corner = scale * corner + offset;
        }
    }
    return triangles;
}

std::string obj(const std::vector<Triangle>& triangles) {
    std::string text;
    for (const Triangle& triangle : triangles) {
        for (const Vector3& v : triangle) {
            text += "v " + to_text(v[0]) + " " + to_text(v[1]) + " " + to_text(v[2]) + "\n";
        }
        text += "f -3 -2 -1\n";
    }
    return text;
}

}  // namespace

TEST_CASE("what a reader passed over and a surface that is open are warnings at the file") {
    const TestFolder folder;
    using Catch::Matchers::Contains;
    folder.write("pole.stl", binary_stl(pole_triangles()));
    CHECK(shape_warnings(folder, "mesh: {file: pole.stl, center_m: [0, -2, 0]}").empty());
    folder.write("pole.stl", binary_stl(pole_triangles()) + "more");
    std::vector<std::string> found = shape_warnings(folder, "mesh: {file: pole.stl, center_m: [0, -2, 0]}");
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Catch::StartsWith("8: environment.obstacles[1].mesh.file '") &&
                             Catch::EndsWith("pole.stl' byte 684: the last 4 bytes are behind the last triangle and "
                                             "are ignored"));
    auto open = pole_triangles();
    open.pop_back();
    folder.write("pole.stl", binary_stl(open));
    found = shape_warnings(folder, "mesh: {file: pole.stl, center_m: [0, -2, 0]}");
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Contains("pole.stl' is open at 3 edges, one of them near [") &&
                             Contains("] in the file: the mesh is a sheet with nothing inside"));
    // Of a file that stands twice it is told once.
    CHECK(shape_warnings(folder,
                         "mesh: {file: pole.stl, center_m: [0, -2, 0]}}\n"
                         "    - {name: b, mesh: {file: pole.stl, center_m: [0, -2, 1]}")
              .size() == 1);
    auto both = scaled(pole_triangles(), 1, {0, 1.5, 0});
    both.insert(both.end(), open.begin(), open.end());
    folder.write("pole.stl", binary_stl(both));
    found = shape_warnings(folder, "mesh: {file: pole.stl, center_m: [0, -2, 0]}");
    REQUIRE(found.size() == 1);
    CHECK_THAT(found[0], Contains("1 of its 2 pieces is a sheet with nothing inside"));
}

TEST_CASE("a corner within an open edge is named, and a shell that faces both ways") {
    const TestFolder folder;
    using Catch::Matchers::Contains;
    const std::string shape = "mesh: {file: pole.stl, center_m: [0, -2, 0]}";
    // The first triangle in two, and its neighbour as it was: their common edge has a corner at its middle.
    std::vector<Triangle> split = pole_triangles();
    const auto [a, b, c] = split[0];
    const Vector3 middle = a + 0.5 * (b - a);
    split[0] = {a, middle, c};
    split.push_back({middle, b, c});
    folder.write("pole.stl", binary_stl(split));
    std::vector<std::string> found = shape_warnings(folder, shape);
    REQUIRE(found.size() == 1);
    const std::string place = "[" + to_text(middle[0], 7) + ", " + to_text(middle[1], 7) + ", " + to_text(middle[2], 7);
    CHECK_THAT(found[0], Contains("is open at 3 edges") && Contains("lies on such an edge at " + place) &&
                             Contains("T-junction") && Contains("split edges at such corners"));

    const auto shells = [](std::size_t turned) {
        std::vector<Triangle> all = box_triangles({3, -4, 0}, {5, 4, 4});
        std::vector<Triangle> inner = box_triangles({3.5, -3, 1}, {4.5, 3, 3});
        for (std::size_t i = 0; i < turned; ++i) {
            std::swap(inner[i][0], inner[i][1]);
        }
        all.insert(all.end(), inner.begin(), inner.end());
        return all;
    };
    for (const auto& [turned, warned] : {std::pair<std::size_t, const char*>{0, ""},
                                         {3, ""},
                                         {4, "33.33 %"},
                                         {5, "41.67 %"},
                                         {7, "41.67 %"},
                                         {9, ""},
                                         {12, ""}}) {
        CAPTURE(turned);
        folder.write("pole.stl", binary_stl(shells(turned)));
        found = shape_warnings(folder, "mesh: {file: pole.stl, center_m: [0, 6, 0]}");
        REQUIRE(found.size() == (*warned == '\0' ? 0 : 1));
        if (!found.empty()) {
            CHECK_THAT(found[0], Contains(std::string("has a piece in which ") + warned + " of the triangles") &&
                                     Contains("let all its triangles face away from what is solid"));
        }
    }
}

TEST_CASE("nobody starts inside a caisson, however its file is rounded, turned or doubled") {
    const TestFolder folder;
    Random random(1);
    // The sound problem starts at x -4 m, z 2 m.
    const std::vector<Triangle> caisson = box_triangles({-6, -4, -1}, {-2, 4, 5});
    const auto rounded = [&random](std::vector<Triangle> triangles) {
        for (Triangle& triangle : triangles) {
            for (Vector3& corner : triangle) {
                for (double& x : corner) {
                    x += 1e-6 * random.integer(-1, 1);
                }
            }
        }
        return triangles;
    };
    const auto with_more = [&caisson](const std::vector<Triangle>& more) {
        std::vector<Triangle> all = caisson;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const auto turned = [](std::vector<Triangle> triangles, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            std::swap(triangles[i][0], triangles[i][1]);
        }
        return triangles;
    };
    const std::string collision = "start is in collision with the obstacle '";
    for (const std::vector<Triangle>& solid :
         {caisson, turned(caisson, 1), turned(caisson, 7), turned(caisson, 12), with_more(caisson),
          with_more(turned(caisson, 12)), with_more(box_triangles({-1, -1, -1}, {1, 1, 1}))}) {
        folder.write("pole.stl", ascii_stl(solid));
        CHECK_THAT(errors_with(folder, "mesh: {file: pole.stl}"), Catch::Contains(collision));
        for (int i = 0; i < 5; ++i) {
            folder.write("pole.stl", ascii_stl(rounded(solid)));
            CHECK_THAT(errors_with(folder, "mesh: {file: pole.stl}"), Catch::Contains(collision));
        }
    }
    for (std::size_t missing = 0; missing < caisson.size(); ++missing) {
        std::vector<Triangle> rest = caisson;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(missing));
        folder.write("pole.stl", ascii_stl(rounded(rest)));
        const std::vector<std::string> warnings = shape_warnings(folder, "mesh: {file: pole.stl}");
        REQUIRE(warnings.size() == 1);
        CAPTURE(missing, warnings[0]);
        CHECK_THAT(warnings[0], Catch::Contains("is open at 3 edges, one of them near ["));
        Vector3 place{};
        const std::size_t at = warnings[0].find("near [");
        REQUIRE(std::sscanf(warnings[0].c_str() + at, "near [%lf, %lf, %lf]", &place[0], &place[1], &place[2]) == 3);
        double off = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector3& a = caisson[missing][k];
            const Vector3& b = caisson[missing][(k + 1) % 3];
            const Vector3 way = place - 0.5 * (a + b);
            off = std::min(off, dot(way, way));
        }
        CHECK(off < 1e-10);
    }
}

TEST_CASE("a unit, an axis or a place that takes a mesh away is a warning with the key that brings it back") {
    const TestFolder folder;
    using Catch::Matchers::Contains;
    const auto warning = [&folder](const std::vector<Triangle>& triangles, const std::string& keys) {
        folder.write("pole.obj", obj(triangles));
        const auto found = shape_warnings(folder, "mesh: {file: pole.obj" + keys + "}");
        REQUIRE(found.size() <= 1);
        return found.empty() ? "none" : found[0];
    };
    const auto pole_m = pole_triangles();
    const auto pole_mm = scaled(pole_m, 1000, {});
    std::vector<Triangle> yup;
    for (const Triangle& triangle : scaled(pole_m, 1, {0, -2, 40})) {
        yup.push_back({});
        for (std::size_t i = 0; i < 3; ++i) {  // z is up, x stays
            yup.back()[i] = {triangle[i][0], triangle[i][2], -triangle[i][1]};
        }
    }
    CHECK(warning(pole_m, ", center_m: [0, -2, 0]") == "none");
    CHECK(warning(pole_mm, ", scale: 0.001, center_m: [0, -2, 0]") == "none");
    const std::string in_mm = warning(pole_mm, ", center_m: [0, -2, 0]");
    CHECK_THAT(in_mm, Contains("mesh.file is 5000 m long, more than a hundred times the bounds") &&
                          Contains("it would be near with `scale: 0.001` (5 m long)"));
    CHECK_THAT(in_mm, !Contains("rpy_deg"));
    CHECK_THAT(
        warning(pole_m, ", scale: 0.001, center_m: [0, -2, 0]"),
        Contains("less than a hundredth of the bounds") && Contains("it would be near with `scale: 1` (5 m long)"));
    CHECK_THAT(warning(yup, ", center_m: [0, 0, -40]"),
               Contains("lies wholly outside of what the robot reaches") &&
                   Contains("it would be near with `rpy_deg: [90, 0, 0]`, for a file whose y axis points up"));
    CHECK(warning(yup, ", center_m: [0, 0, -40], rpy_deg: [90, 0, 0]") == "none");
    CHECK_THAT(warning(scaled(yup, 1000, {}), ", center_m: [0, 0, -40]"),
               Contains("it would be near with `scale: 0.001` (5 m long)") && Contains(" and `rpy_deg: [90, 0, 0]`"));
    CHECK_THAT(warning(scaled(pole_m, 1, {0, 400, 0}), ""),
               Contains("lateral from 402.5 to 403.5 m") && !Contains("near with"));
    const auto on_map = scaled(pole_m, 1, {90000, 5334000, 0});
    CHECK_THAT(warning(scaled(pole_m, 1, {90000, 53340, 0}), ""),
               Contains("it would be near with `offset_m: [90004, 53343, 3]`, for a file in map coordinates"));
    folder.write("pole.obj", obj(on_map));
    CHECK_THAT(errors_with(folder, "mesh: {file: pole.obj}"), Contains("offset_m: [90004, 5334003, 3]"));
    CHECK(warning(on_map, ", offset_m: [90000, 5334002, 0]") == "none");
    const Problem problem = read_with(folder, "mesh: {file: pole.obj, offset_m: [90000, 5334002, 0]}");
    CHECK(Scene(problem.obstacles).bounds(1).low_m == Vector3{3.5, 0.5, 0});
    // Octrees have a place, but no unit.
    folder.write("scan.bt", cube_bt);
    CHECK_THAT(shape_warnings(folder, "octomap: {file: scan.bt, center_m: [0, 9000, 0]}").at(0),
               Contains("octomap.file is 3277 m long") && Contains("wholly outside") && !Contains("scale:"));
}

TEST_CASE("unseen space of an octree is free or occupied, and free space is warned of") {
    const TestFolder folder;
    // Of the highest eighth's eighths the first is occupied and the last is free: cubes of 1638.4 m.
    folder.write("scan.bt", std::string("# Octomap OcTree binary file\nid OcTree\nsize 4\nres 0.1\ndata\n") +
                                std::string("\x00\xc0\x02\x40", 4));
    const auto octomap_with = [&folder](const std::string& keys) {
        return read_with(folder, "octomap: {file: scan.bt, center_m: [0, 0, -4000]" + keys + "}");
    };
    const Problem plain = octomap_with("");
    const Problem free = octomap_with(", unknown: free");
    const Problem filled = octomap_with(", unknown: occupied");
    CHECK(std::get<Octomap>(plain.obstacles.at(1).shape).unknown == UnknownSpace::free);
    CHECK(std::get<Octomap>(filled.obstacles.at(1).shape).unknown == UnknownSpace::occupied);
    CHECK(problem_sha256(plain) == problem_sha256(free));
    CHECK(problem_sha256(plain) != problem_sha256(filled));
    CHECK_THAT(effective_yaml(filled, folder / "."), Catch::Contains("unknown: occupied"));
    CHECK(Scene(plain.obstacles).bounds(1).high_m[0] == Approx(1638.4));
    CHECK(Scene(filled.obstacles).bounds(1).high_m[0] == Approx(3276.8));
    CHECK_THAT(errors_with(folder, "octomap: {file: scan.bt, unknown: solid}"), Catch::Contains("free or occupied"));

    const auto is_of_unseen = [](const std::string& warning) { return warning.find("unknown:") != std::string::npos; };
    const auto warnings_of = [&](const std::string& keys) {
        std::string text;
        for (const std::string& each :
             shape_warnings(folder, "octomap: {file: scan.bt, center_m: [0, 0, -4000]" + keys + "}")) {
            text += is_of_unseen(each) ? each : "";
        }
        return text;
    };
    CHECK_THAT(warnings_of(""), Catch::Contains("octomap.file") && Catch::Contains("has no leaf in 75 % of"));
    CHECK(warnings_of(", unknown: occupied").empty());
    folder.write("scan.bt", cube_bt);  // all of its box is one leaf
    CHECK(warnings_of("").empty());
    CHECK(warnings_of(", unknown: occupied").empty());
    folder.write("scan.bt", std::string("# Octomap OcTree binary file\nid OcTree\nsize 3\nres 0.1\ndata\n") +
                                std::string("\x02\x80", 2));
    CHECK(warnings_of("").empty());  // no free leaf: nobody knows what was seen
    CHECK_THAT(warnings_of(", unknown: occupied"), Catch::Contains("has no free leaf"));
}

TEST_CASE("a problem that is written elsewhere finds its files again, and is the same problem") {
    const TestFolder folder;
    std::filesystem::create_directories(folder / "there/out");
    std::filesystem::create_directory_symlink(folder / "there/out", folder / "link");
    folder.write("pole.stl", binary_stl(pole_triangles()));
    folder.write("scan.bt", cube_bt);
    const Problem problem = read_with(
        folder, "mesh: {file: pole.stl}}\n    - {name: scan, octomap: {file: ./scan.bt, center_m: [0, 0, -50]}");
    for (const char* out : {"there/out", "link", "."}) {
        CAPTURE(out);
        const std::string yaml = effective_yaml(problem, folder / out);
        CHECK_THAT(yaml, !Catch::Contains((folder / "").string()));
        folder.write(std::string(out) + "/effective.yaml", yaml);
        const Problem again = read_problem(folder / out / "effective.yaml");
        CHECK(problem_sha256(again) == problem_sha256(problem));
        CHECK(effective_yaml(again, folder / out) == yaml);
    }
}

TEST_CASE("what is in a file belongs to a problem's hash, its name and format do not") {
    const TestFolder folder;
    const auto hash = [&folder](std::string_view shape) { return problem_sha256(read_with(folder, shape)); };
    folder.write("pole.stl", binary_stl(pole_triangles()));
    folder.write("same.stl", ascii_stl(pole_triangles()));
    auto moved = pole_triangles();
    moved[7][1][2] += 0.001;
    folder.write("moved.stl", binary_stl(moved));
    const std::string sound = hash("mesh: {file: pole.stl}");
    CHECK(hash("mesh: {file: same.stl}") == sound);
    CHECK(hash("mesh: {file: moved.stl}") != sound);
    CHECK(hash("mesh: {file: pole.stl, scale: 1.001}") != sound);
    CHECK(hash("mesh: {file: pole.stl, offset_m: [0, 0, 0.001]}") != sound);
    folder.write("scan.bt", cube_bt);
    const std::string scan = hash("octomap: {file: scan.bt, center_m: [0, 0, -50]}");
    std::string finer = cube_bt;
    folder.write("scan.bt", finer.replace(finer.find("res 0.1"), 7, "res 0.2"));
    CHECK(hash("octomap: {file: scan.bt, center_m: [0, 0, -50]}") != scan);
}

TEST_CASE("a document that could not be read again is an error before it is written") {
    const TestFolder folder;
    const std::filesystem::path latin = folder / "caf\xe9";  // a legal name, but not UTF-8
    std::filesystem::create_directory(latin);
    folder.write("caf\xe9/pole.stl", binary_stl(pole_triangles()));
    folder.write("caf\xe9/robot.yaml", good_robot);
    folder.write("caf\xe9/problem.yaml", edited(good_problem, pole, "mesh: {file: pole.stl}"));
    Problem problem = read_problem(latin / "problem.yaml");
    CHECK_NOTHROW(require_readable_again(problem, latin / "run"));
    const std::string of_mesh = error_of([&] { require_readable_again(problem, folder / "run"); });
    CHECK_THAT(of_mesh, Catch::StartsWith("environment.obstacles[") &&
                            Catch::Contains(".mesh.file: has a path that is not UTF-8"));

    problem = folder.read();
    CHECK_NOTHROW(require_readable_again(problem, folder / "run"));
    const Obstacle box{"a box", Box{{1.25, 2.25, 3.25}}, {-10.125, 30.125, 10.125}, {}};
    problem.obstacles.resize(100000, box);
    CHECK_NOTHROW(require_readable_again(problem, folder / "run"));
    problem.obstacles.resize(150000, box);
    CHECK_THAT(error_of([&] { require_readable_again(problem, folder / "run"); }),
               Catch::StartsWith("environment.obstacles: has ") &&
                   Catch::Contains("expected 2500000 line breaks, commas, colons and brackets or less"));
    problem.obstacles.assign(1000, {std::string(40000, 'x'), Box{{1, 1, 1}}, {0, 30, 0}, {}});
    CHECK_THAT(error_of([&] { require_readable_again(problem, folder / "run"); }),
               Catch::StartsWith("environment.obstacles: has ") && Catch::Contains("expected 32768 KiB or less"));
}
