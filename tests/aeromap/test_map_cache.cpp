#include <bit>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <map>

#include "../grids/grids.hpp"
#include "../support/scratch_folder.hpp"
#include "downwash/aeromap/map_cache.hpp"
#include "downwash/base/files.hpp"
#include "downwash/effects/effect_table.hpp"
#include "scenes.hpp"

using namespace downwash;
using test::scene_of;
using test::ScratchFolder;

namespace {

namespace fs = std::filesystem;

TriangleMesh tetrahedron(double size_m) {
    return {{{0, 0, 0}, {size_m, 0, 0}, {0, size_m, 0}, {0, 0, size_m}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// Everything that makes a map, to be changed one by one.
struct Making {
    std::vector<Obstacle> obstacles = test::bridge();
    AeroSettings settings;
    double radius_m = 0.15;
    RotorNeighbours neighbours;
    PlaneOfMotion plane;
    Bounds extent{-3, 1, 0.4, 4};
    std::vector<double> laterals_m{-0.2, 0.2};

    Making() { settings.grid_m = 0.1; }

    void give_mesh(double size_m, double scale = 1, const std::string& file = "") {
        obstacles[0].shape = Mesh{file, scale, std::make_shared<const TriangleMesh>(tetrahedron(size_m))};
    }
    void give_table(double last_factor) {
        settings.ground.model = EffectModel::table;
        settings.ground.table = std::make_shared<const EffectTable>(std::vector<double>{0.5, 1}, std::vector<double>{},
                                                                    std::vector<double>{1.2, last_factor});
    }
    template <class Edit>
    void give_map(const Edit& edit) {
        FactorGridParts parts = test::two_by_two();
        edit(parts);
        settings.map = std::make_shared<const FactorGrid>(parts);
    }
    void give_last_flag(double flag) {
        give_map([flag](FactorGridParts& parts) { parts.fields.push_back({"flyable", {1, 1, 1, flag}}); });
    }
    void give_box(double side_m) { obstacles[0].shape = Box{{side_m, side_m, side_m}}; }
    void place(double lateral_m, double heading_rad) { plane = PlaneOfMotion({0, lateral_m, 0}, heading_rad); }
    /// A small extent, whose map is soon made.
    static Making small() {
        Making making;
        making.extent = {-3, -2, 0.4, 1.2};
        return making;
    }

    [[nodiscard]] std::vector<MapLayer> layers() const {
        return test::layers(std::make_shared<const DirectEffect>(scene_of(obstacles), settings, radius_m, neighbours),
                            laterals_m);
    }
    /// A map with all blocks.
    [[nodiscard]] AeroMap build() const {
        AeroMap map(layers(), plane, extent);
        map.fill(2);
        return map;
    }
    [[nodiscard]] std::string key() const { return map_key(layers(), plane, extent); }
    [[nodiscard]] bool is_map(const std::string& bytes) const {
        return AeroMap::from_bytes(layers(), plane, extent, bytes).has_value();
    }
    [[nodiscard]] std::shared_ptr<const AeroMap> find(const MapCache& cache) const {
        return cache.find(layers(), plane, extent);
    }
};

/// Whether two maps answer alike everywhere, beyond their extent too.
bool answers_alike(const AeroMap& a, const AeroMap& b) {
    test::Random random(8);
    const Bounds& extent = a.extent();
    for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(extent.x_low_m - 0.2, extent.x_high_m + 0.2);
        const double z = random.uniform(extent.z_low_m - 0.2, extent.z_high_m + 0.2);
        const std::size_t layer = i % 2 == 0 ? 0 : a.layers().size() - 1;
        if (std::bit_cast<std::uint64_t>(a.factor(layer, x, z)) !=
                std::bit_cast<std::uint64_t>(b.factor(layer, x, z)) ||
            a.is_flyable(layer, x, z) != b.is_flyable(layer, x, z)) {
            return false;
        }
    }
    return a.to_bytes() == b.to_bytes();
}

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

fs::path only_file_in(const fs::path& folder) {
    REQUIRE(files_in(folder) == 1);
    return fs::directory_iterator(folder)->path();
}

}  // namespace

TEST_CASE("a map comes back from the cache to the last bit, a given one of large factors too") {
    const ScratchFolder folder;
    const MapCache cache(folder / "made/when/needed");
    Making given;
    given.give_map([](FactorGridParts& parts) {
        parts.x = {-4, 2, 2};
        parts.z = {0, 5, 2};
        parts.fields = {{"factor", {5, 5, 100, 1}}};
    });
    CHECK(given.build().factor(0, -2.9, 3.5) > 5);
    for (const Making& making : {Making(), given}) {
        CHECK(making.find(cache) == nullptr);
        const AeroMap built = making.build();
        REQUIRE(cache.keep(built));
        const auto found = making.find(cache);
        REQUIRE(found);
        CHECK(answers_alike(built, *found));
        CHECK(found->memory_bytes() == built.memory_bytes());
    }
}

TEST_CASE("a map is built once and found from then on") {
    const ScratchFolder folder;
    const Making making;
    int reports = 0;
    const auto get = [&](const fs::path& place) {
        reports = 0;
        auto map = cached_map(place, making.layers(), making.plane, making.extent);
        map->fill(1, [&](double) { ++reports; });
        keep_map(place, *map);
        return map;
    };
    const auto first = get(folder / "maps");
    CHECK(reports > 0);
    const auto second = get(folder / "maps");
    CHECK(reports == 0);
    CHECK(answers_alike(*first, *second));
    // No folder, no cache; one that cannot be made is none either.
    CHECK(answers_alike(*first, *get({})));
    CHECK(reports > 0);
    std::ofstream(folder / "file") << "a file";
    CHECK(answers_alike(*first, *get(folder / "file")));
    CHECK(answers_alike(*first, *get(folder / "file/below")));
    CHECK(reports > 0);
}

TEST_CASE("whatever makes a map is part of its key") {
    using Change = void (*)(Making&);
    const std::vector<std::pair<const char*, Change>> changes{
        {"center", [](Making& m) { m.obstacles[0].center_world_m[1] += 1e-12; }},
        {"attitude", [](Making& m) { m.obstacles[0].rpy_rad[2] = 1e-9; }},
        {"size", [](Making& m) { m.give_box(1); }},
        {"kind", [](Making& m) { m.obstacles[0].shape = Sphere{1}; }},
        {"one obstacle less", [](Making& m) { m.obstacles.pop_back(); }},
        {"order", [](Making& m) { std::swap(m.obstacles[0], m.obstacles[1]); }},
        {"off", [](Making& m) { m.settings.enabled = false; }},
        {"ground", [](Making& m) { m.settings.ground = EffectModel::hayden; }},
        {"ceiling", [](Making& m) { m.settings.ceiling = EffectModel::none; }},
        {"parameter", [](Making& m) { m.settings.ceiling.parameters[0] += 1e-9; }},
        {"cap", [](Making& m) { m.settings.max_factor = 1.9; }},
        {"distance", [](Making& m) { m.settings.min_distance_radii = 0.31; }},
        {"grid", [](Making& m) { m.settings.grid_m = 0.09; }},
        {"radius", [](Making& m) { m.radius_m = 0.151; }},
        {"neighbours", [](Making& m) { m.neighbours = square_quadrotor(2.5); }},
        {"heading", [](Making& m) { m.place(0, 0.1); }},
        {"origin", [](Making& m) { m.place(0.1, 0); }},
        {"x", [](Making& m) { m.extent.x_high_m = 1.1; }},
        {"z", [](Making& m) { m.extent.z_low_m = 0.3; }},
        {"lateral", [](Making& m) { m.laterals_m[1] = 0.21; }},
        {"one layer less", [](Making& m) { m.laterals_m.pop_back(); }},
        {"table", [](Making& m) { m.give_table(1.1); }},
        {"table value", [](Making& m) { m.give_table(1.11); }},
        {"given map", [](Making& m) { m.give_map([](FactorGridParts&) {}); }},
        {"given value", [](Making& m) { m.give_map([](FactorGridParts& p) { p.fields[0].values[3] = 23; }); }},
        {"given place", [](Making& m) { m.give_map([](FactorGridParts& p) { p.x.high_m = 1.5; }); }},
        {"given flyable area", [](Making& m) { m.give_last_flag(1); }},
        {"given flag", [](Making& m) { m.give_last_flag(0); }},
        {"mesh", [](Making& m) { m.give_mesh(1); }},
        {"mesh scale", [](Making& m) { m.give_mesh(1, 2); }},
        {"mesh vertices", [](Making& m) { m.give_mesh(1.1); }},
        {"mesh offset",
         [](Making& m) {
             m.give_mesh(1);
             std::get<Mesh>(m.obstacles[0].shape).offset_m = {0, 0, 0.1};
         }},
    };
    std::map<std::string, std::string> names{{Making().key(), "unchanged"}};
    for (const auto& [name, change] : changes) {
        Making making;
        change(making);
        const auto [known, is_new] = names.emplace(making.key(), name);
        INFO(name << " has the key of " << known->second);
        CHECK(is_new);
    }
    // Names of obstacles and files are no part of it.
    Making one, other;
    one.give_mesh(1, 1, "a.stl");
    other.give_mesh(1, 1, "b.stl");
    other.obstacles[1].name = "renamed";
    CHECK(one.key() == other.key());
    CHECK(one.key() != Making().key());
}

TEST_CASE("a damaged, cut, foreign or misnamed file of the cache is not trusted") {
    const ScratchFolder folder;
    const MapCache cache(folder.path());
    const Making making = Making::small();
    const AeroMap built = making.build();
    REQUIRE(cache.keep(built));
    const fs::path file = only_file_in(folder.path());
    const std::string good = read_file(file, 100'000'000);
    test::Random random(2);
    for (int i = 0; i < 300; ++i) {
        std::string damaged = good;
        const int at = i < 150 ? i : random.integer(0, static_cast<int>(good.size()) - 1);  // every byte of the head
        char& byte = damaged[static_cast<std::size_t>(at)];
        byte = static_cast<char>(byte ^ (1 << random.integer(0, 7)));
        write_file(file, damaged);
        INFO("byte " << at);
        REQUIRE(making.find(cache) == nullptr);
    }
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{10}, std::size_t{100}, good.size() / 2, good.size() - 1}) {
        write_file(file, good.substr(0, size));
        CHECK(making.find(cache) == nullptr);
    }
    write_file(file, good + "x");
    CHECK(making.find(cache) == nullptr);
    fs::remove(file);
    fs::create_directory(file);
    CHECK(making.find(cache) == nullptr);
    fs::remove(file);

    // The file of another map under this one's name.
    Making other = making;
    other.settings.max_factor = 1.5;
    REQUIRE(cache.keep(other.build()));
    fs::rename(only_file_in(folder.path()), file);
    CHECK(making.find(cache) == nullptr);

    // It is built and kept anew.
    write_file(file, good.substr(0, good.size() / 2));
    const auto again = cached_map(folder.path(), making.layers(), making.plane, making.extent);
    CHECK(again->filled_share() == 0);
    again->fill();
    CHECK(answers_alike(*again, built));
    REQUIRE(cache.keep(*again));
    CHECK(making.find(cache) != nullptr);
}

TEST_CASE("bytes that would lead a look-up astray, or that the effects no longer give, are no map") {
    const Making making = Making::small();
    const AeroMap built = making.build();
    const std::string good = built.to_bytes();
    REQUIRE(making.is_map(good));
    CHECK_FALSE(making.is_map(good + '\0'));
    // The first cell stands behind seven counts: its first node, then its steps.
    constexpr std::size_t cell = 7 * sizeof(std::uint64_t);
    REQUIRE(good.substr(cell, 4) == std::string(4, '\0'));
    for (const std::size_t byte :
         {std::size_t{0}, std::size_t{8}, std::size_t{16}, std::size_t{24}, std::size_t{31}, std::size_t{32},
          std::size_t{39}, std::size_t{40}, std::size_t{48}, std::size_t{55}, cell + 3, cell + 4, cell + 5, cell + 6}) {
        std::string bad = good;
        bad[byte] = '\x7f';
        INFO("byte " << byte);
        CHECK_FALSE(making.is_map(bad));
    }
    std::string no_number = good;
    no_number.replace(no_number.size() - 4, 4, "\xff\xff\xff\xff");
    CHECK_FALSE(making.is_map(no_number));
    Making changed = making;
    changed.settings.ground = EffectModel::he;  // as if the code of the model had changed
    CHECK_FALSE(changed.is_map(good));
}

TEST_CASE("blocks of equal values in two layers are kept once, and only such blocks") {
    const auto equal_blocks = [](const AeroMap& map) {
        std::size_t equal = 0;
        const MapView& view = map.view(0);
        for (std::uint32_t k = 0; k < view.rows; k += MapBlock::side_cells) {
            for (std::uint32_t i = 0; i < view.columns; i += MapBlock::side_cells) {
                equal += &block_around(view, i, k) == &block_around(map.view(1), i, k) ? 1 : 0;
            }
        }
        return equal;
    };
    Making making = Making::small();
    making.obstacles = {{"floor", Box{{20, 20, 1}}, {0, 0, -0.5}, {}}};
    const AeroMap both = making.build();
    const std::size_t blocks = equal_blocks(both);
    const auto over = [](std::uint32_t cells) { return (cells + MapBlock::side_cells - 1) / MapBlock::side_cells; };
    CHECK(blocks == std::size_t{over(both.view(0).columns)} * over(both.view(0).rows));
    const std::string bytes = both.to_bytes();
    const auto read = AeroMap::from_bytes(making.layers(), making.plane, making.extent, bytes);
    REQUIRE(read);
    CHECK(equal_blocks(*read) == blocks);
    CHECK(read->to_bytes() == bytes);
    CHECK(read->memory_bytes() == both.memory_bytes());

    // A second layer, under half a ceiling.
    making.obstacles.push_back({"ceiling", Box{{20, 4, 1}}, {0, 2, 2}, {}});
    const AeroMap apart = making.build();
    CHECK(equal_blocks(apart) < blocks);
    CHECK(apart.to_bytes().size() > bytes.size());
    CHECK(apart.memory_bytes() > both.memory_bytes());
    making.laterals_m = {-0.2, -0.2};
    const std::string said_to_be_one = making.build().to_bytes();
    making.laterals_m = {-0.2, 0.2};
    CHECK_FALSE(making.is_map(said_to_be_one));
}

TEST_CASE("a run adds what it filled to the cache, and files that grow many become one") {
    const ScratchFolder folder;
    const MapCache cache(folder.path());
    const Making making;
    const AeroMap whole = making.build();
    double share = 0;
    for (int run = 0; run < 12; ++run) {
        const auto map = cached_map(folder.path(), making.layers(), making.plane, making.extent);
        CHECK(map->filled_share() == share);
        CHECK(cache.keep(*map));  // nothing is new: nothing is written
        const std::size_t files = run == 0 ? 0 : files_in(folder.path());
        const double x_m = making.extent.x_low_m + 0.15 + 0.3 * run;
        CHECK(map->factor(0, x_m, 1.05) == whole.factor(0, x_m, 1.05));
        CHECK(map->factor(1, x_m, 3.5) == whole.factor(1, x_m, 3.5));
        CHECK(map->filled_share() >= share);
        const bool is_more = map->filled_share() > share;
        share = map->filled_share();
        CHECK(cache.keep(*map));
        CHECK(files_in(folder.path()) < 8);
        CHECK((files_in(folder.path()) != files) == is_more);
    }
    const auto last = making.find(cache);
    REQUIRE(last);
    last->fill();
    CHECK(answers_alike(*last, whole));
}

TEST_CASE("two programs that fill the same map at once keep the blocks of both") {
    const ScratchFolder folder;
    const MapCache cache(folder.path());
    const Making making;
    const AeroMap one(making.layers(), making.plane, making.extent);
    const AeroMap other(making.layers(), making.plane, making.extent);
    for (const AeroMap* map : {&one, &other}) {
        static_cast<void>(map->factor(0, -1, 2));  // both
    }
    static_cast<void>(one.factor(0, -2.9, 0.5));
    static_cast<void>(other.factor(1, 0.9, 3.9));
    REQUIRE(cache.keep(one));
    REQUIRE(cache.keep(other));
    const auto found = making.find(cache);
    REQUIRE(found);
    CHECK(found->filled_share() == Approx(one.filled_share() * 3 / 2));
    static_cast<void>(one.factor(1, 0.9, 3.9));
    CHECK(found->to_bytes() == one.to_bytes());

    // A damaged file costs its blocks only.
    fs::path last;
    for (const auto& entry : fs::directory_iterator(folder.path())) {
        last = entry.path();
    }
    write_file(last, read_file(last, 100'000'000).substr(0, 1000));
    const auto rest = making.find(cache);
    REQUIRE(rest);
    CHECK(rest->filled_share() == Approx(one.filled_share() * 2 / 3));
}

TEST_CASE("a cache holds 32 maps, the last used ones") {
    const ScratchFolder folder;
    const MapCache cache(folder.path());
    Making making;
    making.obstacles.clear();
    making.extent = {0, 0.5, 0, 0.5};
    const auto keep = [&](int number) {
        making.extent.x_high_m = 0.5 + 0.001 * number;
        REQUIRE(cache.keep(making.build()));
        for (const auto& entry : fs::directory_iterator(folder.path())) {  // each an hour older than the next
            fs::last_write_time(entry, entry.last_write_time() - std::chrono::hours(1));
        }
    };
    for (int number = 0; number < 32; ++number) {
        keep(number);
    }
    CHECK(files_in(folder.path()) == 32);
    making.extent.x_high_m = 0.5;
    REQUIRE(making.find(cache));  // the oldest one is used again
    std::ofstream(folder / "notes.txt") << "not ours";
    std::ofstream(folder / "abc.aeromap.1-1.part") << "unfinished";
    fs::last_write_time(folder / "abc.aeromap.1-1.part", fs::file_time_type::clock::now() - std::chrono::hours(2));
    keep(32);
    CHECK(files_in(folder.path()) == 33);
    CHECK(fs::exists(folder / "notes.txt"));
    making.extent.x_high_m = 0.5;
    CHECK(making.find(cache));
    making.extent.x_high_m = 0.501;
    CHECK_FALSE(making.find(cache));
}
