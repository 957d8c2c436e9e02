#include <catch2/catch.hpp>
#include <limits>

#include "../support/error_of.hpp"
#include "../support/mesh_bytes.hpp"
#include "../support/random.hpp"
#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/mesh_file.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr std::string_view ascii_triangle = R"(solid one
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      vertex 1 0 0
      vertex 0 1 2.5e0
    endloop
  endfacet
endsolid one
)";

std::string said_of(std::string_view bytes, const std::string& name) {
    return error_of([&] { return parse_mesh(bytes, name); });
}

std::string ascii_with(std::string_view from, std::string_view to) {
    std::string text(ascii_triangle);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
    std::vector<Triangle> triangles;
    for (const auto& corners : mesh.triangles) {
        triangles.push_back(
            {mesh.vertices_m.at(corners[0]), mesh.vertices_m.at(corners[1]), mesh.vertices_m.at(corners[2])});
    }
    return triangles;
}

std::string words(const Vector3& v) {
    return " " + to_text(v[0]) + " " + to_text(v[1]) + " " + to_text(v[2]) + "\n";
}

std::string ascii_stl(const std::vector<Triangle>& triangles) {
    std::string text = "solid\n";
    for (const Triangle& t : triangles) {
        text += "facet normal 0 0 0\nouter loop\nvertex" + words(t[0]) + "vertex" + words(t[1]) + "vertex" +
                words(t[2]) + "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
}

std::string obj(const std::vector<Triangle>& triangles) {
    std::string text;
    for (const Triangle& t : triangles) {
        text += "v" + words(t[0]) + "v" + words(t[1]) + "v" + words(t[2]) + "f -3 -2 -1\n";
    }
    return text;
}

}  // namespace

TEST_CASE("The same triangles come from binary STL, ASCII STL and OBJ") {
    Random random(1);
    std::vector<Triangle> triangles(50);
    for (Triangle& triangle : triangles) {
        for (Vector3& corner : triangle) {
            for (double& number : corner) {
                number = static_cast<float>(random.magnitude(-20, 6));
            }
        }
    }
    CHECK(triangles_of(parse_mesh(binary_stl(triangles), "a.stl")) == triangles);
    CHECK(triangles_of(parse_mesh(ascii_stl(triangles), "a.stl")) == triangles);
    CHECK(triangles_of(parse_mesh(obj(triangles), "a.obj")) == triangles);
    // A binary STL file is told by its size, even when it begins with solid.
    const auto box = box_triangles({0, 0, 0}, {1, 2, 3});
    CHECK(triangles_of(parse_mesh(binary_stl(box, "solid box"), "a.STL")) == box);
}

TEST_CASE(
    "ASCII STL may hold several solids, upper case and CRLF, OBJ texture, normals, polygons and corners counted back") {
    std::string text;
    for (const char c : std::string(ascii_triangle) + std::string(ascii_triangle)) {
        text += c == '\n' ? "\r\n" : std::string(1, static_cast<char>(std::toupper(c)));
    }
    const Triangle triangle{Vector3{0, 0, 0}, {1, 0, 0}, {0, 1, 2.5}};
    CHECK(triangles_of(parse_mesh(text, "a.stl")) == std::vector<Triangle>{triangle, triangle});
    const std::string polygons =
        "# a pentagon\nmtllib a.mtl\no part\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 .5 .5 .5\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
        "usemtl steel\ns off\nf 1/1 2//1 3/1/1 -1/-1/-1\nv 0 0 5\n  f +1 2 -1\n";
    const TriangleMesh mesh = parse_mesh(polygons, "a.obj");
    CHECK(mesh.vertices_m == std::vector<Vector3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 5}});
    CHECK(mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 1, 4}});
}

TEST_CASE("Wrong ASCII STL is an error with its line") {
    const auto [bytes, said] = GENERATE(table<std::string, std::string>({
        {ascii_with("facet normal 0 0 1", "facet normal 0 0"),
         "line 2: found 2 words after 'facet normal', expected 3 numbers"},
        {ascii_with("facet normal 0 0 1", "facet normal nan 0 1"),
         "line 2: found 'nan', expected a finite number of at most 1e6 in size"},
        {ascii_with("facet", "face"), "line 2: found 'face', expected 'facet' or 'endsolid'"},
        {ascii_with("outer loop", "outer"), "line 3: found 'outer', expected 'outer loop'"},
        {ascii_with("vertex 1 0 0", "vertex 1 0 inf"),
         "line 5: found 'inf', expected a finite number of at most 1e6 in size"},
        {ascii_with("vertex 1 0 0", "vertex 1 0 1e7"),
         "line 5: found '1e7', expected a finite number of at most 1e6 in size"},
        {ascii_with("vertex 1 0 0", "vertex 1,0 0 0"),
         "line 5: found '1,0', expected a finite number of at most 1e6 in size"},
        {ascii_with("vertex 1 0 0\n", "\n"), "line 7: found 'endloop', expected 'vertex'"},
        {ascii_with("endloop", "vertex 1 1 1"), "line 7: found 'vertex', expected 'endloop'"},
        {ascii_with("endsolid one", ""), "line 9: the file ends here: expected 'endsolid'"},
        {std::string(ascii_triangle) + "more", "line 10: found 'more', expected 'solid'"},
        {"solid nothing\nendsolid\n", "has no triangles: expected at least one"},
    }));
    CHECK(said_of(bytes, "a.stl") == "'a.stl' " + said);
}

TEST_CASE("Wrong binary STL is an error with its byte") {
    const std::string sound = binary_stl(box_triangles({0, 0, 0}, {1, 1, 1}));
    REQUIRE(said_of(sound, "a.stl") == "none");
    const auto with = [&sound](std::size_t at, const std::string& bytes) {
        return std::string(sound).replace(at, bytes.size(), bytes);
    };
    const auto bits = [](float number) { return little_endian(std::bit_cast<std::uint32_t>(number)); };
    CHECK(said_of(sound.substr(0, 83), "a.stl") ==
          "'a.stl' has 83 bytes: expected 84 or more in binary, or a first line 'solid' in ASCII");
    CHECK(said_of("", "a.stl") ==
          "'a.stl' has 0 bytes: expected 84 or more in binary, or a first line 'solid' in ASCII");
    CHECK(said_of(sound.substr(0, 683), "a.stl") ==
          "'a.stl' byte 80: says 12 triangles, expected 84 + 50 times as many bytes, 684, found 683");
    CHECK(said_of(with(80, little_endian(4294967295U)), "a.stl") ==
          "'a.stl' byte 80: says 4294967295 triangles, expected 84 + 50 times as many bytes, 214748364834, found 684");
    CHECK(said_of(with(80, std::string("\0\0\0\x0c", 4)), "a.stl") ==
          "'a.stl' byte 80: the count of triangles is big-endian: expected little-endian numbers");
    CHECK(said_of(with(96, bits(std::numeric_limits<float>::quiet_NaN())), "a.stl") ==
          "'a.stl' byte 96: found nan, expected a finite number of at most 1e6 in size, little-endian");
    CHECK(said_of(with(84 + 50 + 44, bits(-std::numeric_limits<float>::infinity())), "a.stl") ==
          "'a.stl' byte 178: found -inf, expected a finite number of at most 1e6 in size, little-endian");
    CHECK(said_of(with(84, bits(2e6F)), "a.stl") ==
          "'a.stl' byte 84: found 2e+06, expected a finite number of at most 1e6 in size, little-endian");
    CHECK(said_of(binary_stl({}), "a.stl") == "'a.stl' has no triangles: expected at least one");
}

TEST_CASE("Wrong OBJ is an error with its line") {
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto [bytes, said] = GENERATE_COPY(table<std::string, std::string>({
        {"v 1 2\n", "line 1: a vertex of 2 numbers: expected 3"},
        {"\n\nv 1 2 nan\n", "line 3: found 'nan', expected a finite number of at most 1e6 in size"},
        {"v 1 2 3 inf\n", "line 1: found 'inf', expected a finite number of at most 1e6 in size"},
        {three + "f 1 2\n", "line 4: a face of 2 corners: expected at least 3"},
        {three + "f 1 2 4\n", "line 4: refers to vertex 4: expected one of the 3 before this line"},
        {three + "f 1 2 -4\n", "line 4: refers to vertex -4: expected one of the 3 before this line"},
        {three + "f 1 2 0\n", "line 4: found '0', expected a corner as i, i/t, i//n or i/t/n, none of them 0"},
        {three + "f 1 2 3/\n", "line 4: found '3/', expected a corner as i, i/t, i//n or i/t/n, none of them 0"},
        {three + "f 1 2 3//\n", "line 4: found '3//', expected a corner as i, i/t, i//n or i/t/n, none of them 0"},
        {three + "f 1 2 3/1/1/1\n",
         "line 4: found '3/1/1/1', expected a corner as i, i/t, i//n or i/t/n, none of them 0"},
        {three + "f 1 2 99999999999999999999\n",
         "line 4: found '99999999999999999999', expected a corner as i, i/t, i//n or i/t/n, none of them 0"},
        {three + "face 1 2 3\n", "line 4: found 'face', expected a statement like 'v' or 'f'"},
        {three + "surf 0 1 0 1 1 2 3\n",
         "line 4: 'surf' is not read, and a surface may depend on it: expected polygons, 'f', only"},
        {three, "has no triangles: expected at least one"},
        {"", "has no triangles: expected at least one"},
    }));
    CHECK(said_of(bytes, "a.obj") == "'a.obj' " + said);
}

TEST_CASE("Meshes of more than two million triangles are errors") {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int i = 0; i < 2'000'002; ++i) {
        text += i % 2 == 0 ? " 1" : " 2";
    }
    CHECK(said_of(text, "a.obj") == "none");
    CHECK(said_of(text + " 3", "a.obj") == "'a.obj' line 4: more triangles than expected, which is at most 2000000");
}

TEST_CASE("A line of more words than any face has corners is an error, whatever it says") {
    std::string words = "#";
    for (int i = 1; i < 2'001'000; ++i) {
        words += " x";
    }
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    CHECK(said_of(three + words + "\n", "a.obj") == "none");
    CHECK(said_of(three + words + " x\n", "a.obj") ==
          "'a.obj' line 5: has more than 2001000 words: expected one statement in a line");
}

TEST_CASE("No beginning of an STL file passes for the whole") {
    const auto box = box_triangles({0, 0, 0}, {1, 1, 1});
    std::string ascii = ascii_stl(box);
    ascii.pop_back();  // its last line break may be missing
    for (const std::string& whole : {binary_stl(box, "solid box"), ascii}) {
        for (std::size_t size = 0; size < whole.size(); ++size) {
            CAPTURE(size);
            REQUIRE(said_of(whole.substr(0, size), "a.stl") != "none");
        }
    }
}

TEST_CASE("A mesh file that cannot be read is told by its name") {
    const ScratchFolder folder;
    write_file(folder / "a.ply", "ply");
    const auto said_of_file = [&folder](const std::string& name) {
        return error_of([&] { return read_mesh(folder / name); });
    };
    const std::string in = "'" + folder.path().string() + "/";
    CHECK(said_of_file("none.stl") == in + "none.stl' cannot be read: there is no such file");
    CHECK(said_of_file("a.ply") == in + "a.ply' is of an unknown kind: expected a name that ends in .stl or .obj");
    write_file(folder / "a.stl", ascii_triangle);
    CHECK(said_of_file("a.stl") == "none");
}
