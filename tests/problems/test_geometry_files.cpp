#include "../support/error_of.hpp"
#include "../support/mesh_bytes.hpp"
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
          "number of at most 1e6 in size");
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
          "problem.yaml:8:45: unknown key 'scale' in environment.obstacles[1].octomap: expected file, center_m or "
          "rpy_deg");
}

TEST_CASE("surfaces that cannot be placed are errors at their obstacle") {
    const TestFolder folder;
    folder.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    CHECK_THAT(errors_with(folder, "mesh: {file: line.obj}"),
               Catch::StartsWith("problem.yaml:8:") && Catch::Contains("area"));
    folder.write("pole.stl", binary_stl(pole_triangles()));
    CHECK(errors_with(folder, "mesh: {file: pole.stl, scale: 1e6}") ==
          "problem.yaml:8:33: environment.obstacles[1].mesh.file has a vertex that is not finite or, once scaled, "
          "farther than 1e6 m from its origin");
    CHECK(errors_with(folder, "mesh: {file: pole.stl, scale: 0}") ==
          "problem.yaml:8:50: environment.obstacles[1].mesh.scale is 0: expected a number from 1e-06 to 1000000");
    // Bodies of a robot are no meshes.
    CHECK(errors_after_robot(folder, "box: {size_m: [1, 1, 0.2], center_m: [0, 0, 0]}", "mesh: {file: a.stl}") ==
          "robot.yaml:7:7: unknown key 'mesh' in multirotor.body[0]: expected box, cylinder or sphere\n"
          "robot.yaml:7:7: multirotor.body[0] needs exactly one of box, cylinder or sphere");
}

TEST_CASE("more triangles than a scene holds are not even kept") {
    const TestFolder folder;
    std::string fan = "v 0 100 0\nv 1 100 0\nv 0 101 0\nf";
    for (int i = 0; i < 1'200'002; ++i) {
        fan += " " + std::to_string(1 + i % 3);
    }
    folder.write("fan.obj", fan);
    CHECK(errors_with(folder, "mesh: {file: fan.obj}}\n    - {name: other, mesh: {file: fan.obj}") ==
          "problem.yaml:9:34: environment.obstacles[2].mesh.file 'fan.obj' makes 2400000 triangles and cubes of all "
          "obstacles: expected at most 2000000");
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
