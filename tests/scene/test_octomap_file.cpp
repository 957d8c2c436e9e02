#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>
#include <tuple>
#include <type_traits>

#include "../support/error_of.hpp"
#include "../support/random.hpp"
#include "downwash/scene/octomap_file.hpp"

using namespace downwash;
using downwash::test::Random;

namespace {

const std::string header = "# Octomap OcTree binary file\n# a comment\nid OcTree\nsize 3\nres 0.5\ndata\n";
// The root's children: 0 is occupied, 7 follows. Of that one's, child 5 is free: the tree has four nodes.
const std::string nodes("\x02\xc0\x00\x04", 4);

std::string sound() {
    std::string text = header;
    return text.replace(text.find("size 3"), 6, "size 4") + nodes;
}

std::string with(std::string_view from, std::string_view to) {
    std::string text = sound();
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

std::string said_of(std::string_view bytes) {
    return test::error_of([&] { return parse_octomap(bytes, "a.bt"); });
}

/// Cubes as (side, centre), in a certain order.
using Cubes = std::vector<std::tuple<double, double, double, double>>;

Cubes sorted(Cubes cubes) {
    std::sort(cubes.begin(), cubes.end());
    return cubes;
}

Cubes cubes_of(const OccupancyTree& tree) {
    Cubes cubes;
    for (const OccupiedCube& cube : tree.cubes) {
        cubes.emplace_back(cube.side_m, cube.center_local_m[0], cube.center_local_m[1], cube.center_local_m[2]);
    }
    return sorted(cubes);
}

/// What OctoMap itself holds occupied.
template <class Tree>
requires std::is_base_of_v<octomap::AbstractOcTree, Tree> Cubes cubes_of(const Tree& tree) {
    Cubes cubes;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
        if (tree.isNodeOccupied(*leaf)) {
            // Its coordinates are floats: from the key they are doubles.
            const octomap::OcTreeKey key = leaf.getIndexKey();
            const unsigned depth = leaf.getDepth();
            cubes.emplace_back(tree.getNodeSize(depth), tree.keyToCoord(key[0], depth), tree.keyToCoord(key[1], depth),
                               tree.keyToCoord(key[2], depth));
        }
    }
    return sorted(cubes);
}

/// A tree of occupied and free voxels near the origin, some blocks of them full and so pruned to larger cubes.
template <class Tree>
void fill(Tree& tree, Random& random) {
    const int corner = random.integer(-40, 30);
    for (int i = 0; i < 300; ++i) {
        const auto near = [&random, corner] {
            return static_cast<std::uint16_t>(32768 + corner + random.integer(0, 15));
        };
        tree.updateNode(octomap::OcTreeKey(near(), near(), near()), random.integer(0, 2) > 0);
    }
    const auto block = static_cast<std::uint16_t>(32768 + 16 * random.integer(-3, 3));
    for (int i = 0; i < 8 * 8 * 8; ++i) {
        const auto at = [block](int offset) { return static_cast<std::uint16_t>(block + offset); };
        for (int hits = 0; hits < 8; ++hits) {  // up to the greatest probability: only equal leaves are pruned
            tree.updateNode(octomap::OcTreeKey(at(i % 8), at(i / 8 % 8), at(i / 64)), true);
        }
    }
    tree.prune();
}

}  // namespace

TEST_CASE("Two bits for each child, out to voxels in the outermost corners") {
    const OccupancyTree tree = parse_octomap(sound(), "a.bt");
    CHECK(tree.resolution_m == 0.5);
    // The lowest eighth of 65536 cells of half a metre.
    CHECK(cubes_of(tree) == Cubes{{16384, -8192, -8192, -8192}});
    octomap::OcTree corners(0.25);
    corners.updateNode(octomap::OcTreeKey(0, 0, 0), true);
    corners.updateNode(octomap::OcTreeKey(65535, 65535, 65535), true);
    std::stringstream stream;
    corners.writeBinary(stream);
    CHECK(cubes_of(parse_octomap(stream.str(), "a.bt")) ==
          Cubes{{0.25, -8191.875, -8191.875, -8191.875}, {0.25, 8191.875, 8191.875, 8191.875}});
}

TEST_CASE("What OctoMap writes is read as OctoMap holds it") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        octomap::OcTree tree(random.uniform(0.01, 0.5));
        fill(tree, random);
        std::stringstream full;
        tree.write(full);
        const OccupancyTree found = parse_octomap(full.str(), "a.ot");
        // The header has six digits of the resolution, so it is OctoMap's own reading that counts.
        const std::unique_ptr<octomap::AbstractOcTree> again(octomap::AbstractOcTree::read(full));
        REQUIRE(cubes_of(found) == cubes_of(dynamic_cast<const octomap::OcTree&>(*again)));
        REQUIRE(std::any_of(found.cubes.begin(), found.cubes.end(),
                            [&found](const OccupiedCube& cube) { return cube.side_m > 7 * found.resolution_m; }));

        std::stringstream binary;
        tree.writeBinary(binary);
        octomap::OcTree binary_again(0.1);
        REQUIRE(binary_again.readBinary(binary));
        REQUIRE(cubes_of(parse_octomap(binary.str(), "a.bt")) == cubes_of(binary_again));
    }
}

TEST_CASE("What no leaf covers in the box of all leaves is unseen, as OctoMap has it") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        octomap::OcTree tree(0.125);
        fill(tree, random);
        std::stringstream full;
        tree.write(full);
        const OccupancyTree found = parse_octomap(full.str(), "a.ot");
        CHECK(found.has_free_leaf);
        CHECK(found.lists_unseen);
        double known_m3 = 0;
        Vector3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
        for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
            const octomap::OcTreeKey key = leaf.getIndexKey();
            const double side_m = leaf.getSize();
            known_m3 += side_m * side_m * side_m;
            for (unsigned axis = 0; axis < 3; ++axis) {
                const double middle_m = tree.keyToCoord(key[axis], leaf.getDepth());
                low[axis] = std::min(low[axis], middle_m - side_m / 2);
                high[axis] = std::max(high[axis], middle_m + side_m / 2);
            }
        }
        const LocalBox& box = found.known_box;
        CHECK(box.center_m - 0.5 * box.size_m == low);
        CHECK(box.center_m + 0.5 * box.size_m == high);
        const double box_m3 = box.size_m[0] * box.size_m[1] * box.size_m[2];
        double unseen_m3 = 0;
        for (const LocalBox& each : found.unseen) {
            unseen_m3 += each.size_m[0] * each.size_m[1] * each.size_m[2];
        }
        CHECK(unseen_m3 == Approx(box_m3 - known_m3));
        CHECK(found.unseen_share == Approx(unseen_m3 / box_m3));
        for (int i = 0; i < 2000; ++i) {
            Vector3 p{};
            for (unsigned axis = 0; axis < 3; ++axis) {
                p[axis] = random.uniform(low[axis], high[axis]);
            }
            const bool is_unseen = std::any_of(found.unseen.begin(), found.unseen.end(), [&p](const LocalBox& each) {
                const Vector3 d = p - each.center_m;
                return std::abs(d[0]) < each.size_m[0] / 2 && std::abs(d[1]) < each.size_m[1] / 2 &&
                       std::abs(d[2]) < each.size_m[2] / 2;
            });
            REQUIRE(is_unseen == (tree.search(p[0], p[1], p[2]) == nullptr));
        }
        std::stringstream binary;
        tree.writeBinary(binary);
        CHECK(parse_octomap(binary.str(), "a.bt").unseen_share == found.unseen_share);
    }
    const OccupancyTree tree = parse_octomap(sound(), "a.bt");
    // An eighth, and an eighth of the one across, whose lower half along y the box ends with.
    CHECK(tree.unseen_share == Approx(1 - (1.0 + 1.0 / 8) / (2 * 1.5 * 2)));
}

TEST_CASE("An octree with colours is read as the same one without them") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        octomap::OcTree plain(0.1);
        octomap::ColorOcTree colored(0.1);
        Random random(seed);
        fill(plain, random);
        random = Random(seed);
        fill(colored, random);
        for (auto leaf = colored.begin_leafs(); leaf != colored.end_leafs(); ++leaf) {
            const auto part = [&random] { return static_cast<std::uint8_t>(random.integer(0, 255)); };
            leaf->setColor(part(), part(), part());
        }
        for (const bool is_binary : {true, false}) {
            std::stringstream of_plain, of_colored;
            is_binary ? plain.writeBinary(of_plain) : plain.write(of_plain);
            is_binary ? colored.writeBinary(of_colored) : colored.write(of_colored);
            REQUIRE(of_colored.str().find("id ColorOcTree") != std::string::npos);
            const OccupancyTree found = parse_octomap(of_colored.str(), "a.ot");
            REQUIRE(cubes_of(found) == cubes_of(parse_octomap(of_plain.str(), "a.ot")));
            const std::string whole = of_colored.str();
            for (std::size_t missing = 1; missing < 20; ++missing) {
                REQUIRE_THAT(said_of(whole.substr(0, whole.size() - missing)), Catch::Contains("the file ends after"));
            }
        }
    }
}

TEST_CASE("Wrong octree headers are errors with their line") {
    REQUIRE(said_of(sound()) == "none");
    for (const auto& [bytes, said] : {
             std::pair<std::string, std::string>{
                 "", "1: found '', expected '# Octomap OcTree binary file' or '# Octomap OcTree file'"},
             {"solid\n", "1: found 'solid', expected '# Octomap OcTree binary file' or '# Octomap OcTree file'"},
             {with("id OcTree", "id OcTreeStamped"),
              "3: a tree of kind 'OcTreeStamped': expected OcTree or ColorOcTree"},
             {with("id OcTree\n", ""), "5: the header ends: expected a line 'id' before it"},
             {with("size 4", "size -4"), "4: found '-4', expected the number of nodes"},
             {with("res 0.5", "res 0"), "5: found '0', expected a resolution from 0.0001 to 30 m"},
             {with("res 0.5", "res nan"), "5: found 'nan', expected a resolution from 0.0001 to 30 m"},
             {with("res 0.5", "res 31"), "5: found '31', expected a resolution from 0.0001 to 30 m"},
             {with("res 0.5", "size 4"), "5: found 'size', expected id, size and res once each, then 'data'"},
             {with("res 0.5", "res 0.5 m"), "5: found 3 words, expected a key and its value, or 'data'"},
             {sound().substr(0, sound().find("data")), "5: the header ends here: expected a line 'data' of its own"},
         }) {
        CHECK(said_of(bytes) == "'a.bt' line " + said);
    }
}

TEST_CASE("Wrong streams of nodes are errors with their byte") {
    const std::size_t data = header.size();
    const auto at = [data](std::size_t node) { return "'a.bt' byte " + std::to_string(data + node) + ": "; };
    CHECK(said_of(header + nodes) == at(4) + "more nodes than 3: expected as many as the header's size");
    CHECK(said_of(with("size 4", "size 5")) == at(4) + "the nodes end after 4: expected 5 as the header's size says");
    CHECK(said_of(sound() + "x") == at(4) + "the file continues after its last node: expected its end");
    CHECK(said_of(sound().substr(0, data + 3)) == at(3) + "the file ends after 3 of 4 nodes: expected all of them");
    CHECK(said_of(with("size 4", "size 18446744073709551615").substr(0, data + 22)) ==
          at(22) + "the file ends after 3 of 18446744073709551615 nodes: expected all of them");
    CHECK(said_of(with(nodes, std::string("\x02\xc0\x00\x00", 4))) ==
          at(2) + "a node without children among the inner nodes: expected at least one child");
    CHECK(said_of(with("size 4", "size 2").substr(0, data) + std::string("\x01\x00", 2)) ==
          "'a.bt' has no occupied leaf: expected at least one");
    // Sixteen levels end at the resolution; there is nothing below.
    std::string deep = with("size 4", "size 99").substr(0, data + 1);
    for (int i = 0; i < 20; ++i) {
        deep += std::string("\x03\x00", 2);
    }
    CHECK(said_of(deep) == at(33) + "a node below level 16: expected no more levels");
}

TEST_CASE("Probabilities that are none are errors, as are those of the other byte order") {
    octomap::OcTree tree(0.1);
    Random random(3);
    fill(tree, random);
    std::stringstream stream;
    tree.write(stream);
    const std::string whole = stream.str();
    const std::size_t data = whole.find("data\n") + 5;
    REQUIRE(said_of(whole) == "none");
    std::string holding_nan = whole;
    holding_nan.replace(data, 4, std::string("\x00\x00\xc0\x7f", 4));
    CHECK(said_of(holding_nan) == "'a.bt' byte " + std::to_string(data) +
                                      ": found log odds of nan, expected a finite number of at most 1000 in size, "
                                      "little-endian");
    std::string swapped = whole;
    for (std::size_t node = data; node < swapped.size(); node += 5) {
        std::reverse(swapped.begin() + static_cast<std::ptrdiff_t>(node),
                     swapped.begin() + static_cast<std::ptrdiff_t>(node) + 4);
    }
    CHECK_THAT(said_of(swapped), Catch::Contains("little-endian"));
}

TEST_CASE("No beginning of an octree file passes for the whole, nor does one with a byte more") {
    octomap::OcTree tree(0.1);
    Random random(4);
    fill(tree, random);
    std::stringstream full, binary;
    tree.write(full);
    tree.writeBinary(binary);
    for (const std::string& whole : {full.str(), binary.str()}) {
        REQUIRE(said_of(whole) == "none");
        REQUIRE(said_of(whole + '\0') != "none");
        for (std::size_t size = 0; size < whole.size(); ++size) {
            REQUIRE(said_of(whole.substr(0, size)) != "none");
        }
    }
}
