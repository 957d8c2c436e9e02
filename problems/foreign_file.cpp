#include "downwash/problems/foreign_file.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "downwash/base/text.hpp"
#include "downwash/problems/robot_sources.hpp"

namespace downwash::problems {
namespace {

bool has_ending(const std::filesystem::path& file, std::span<const std::string_view> endings) {
    const std::string ending = file.extension().string();
    return std::ranges::any_of(endings, [&](std::string_view known) { return is_same_word(known, ending); });
}

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

std::string_view first_line_of(std::string_view text) {
    return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace

std::string foreign_file_text(const std::filesystem::path& file, std::string_view text) {
    constexpr std::array<std::string_view, 5> meshes{".stl", ".obj", ".ply", ".off", ".dae"};
    constexpr std::array<std::string_view, 2> octrees{".bt", ".ot"};
    constexpr std::array<std::string_view, 2> tables{".csv", ".tsv"};
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    text = trimmed(text);
    const std::string_view beginning = text.substr(0, 4096);
    const std::string_view line = first_line_of(text);
    if (has_ending(file, meshes) || (line.starts_with("solid") && beginning.find("facet") != std::string_view::npos)) {
        return "is a mesh: expected YAML; a mesh (.stl or .obj) stands in a problem file as an obstacle, "
               "{name: bridge, mesh: {file: " +
               file.filename().string() + "}} in environment.obstacles";
    }
    if (has_ending(file, octrees) || line.starts_with("# Octomap")) {
        return "is an octree: expected YAML; an octree stands in a problem file as an obstacle, {name: scan, octree: "
               "{file: " +
               file.filename().string() + "}} in environment.obstacles";
    }
    if (text.starts_with('<')) {
        const bool is_robot = beginning.find("<robot") != std::string_view::npos;
        if (!is_robot && beginning.find("<sdf") == std::string_view::npos) {
            return "is XML: expected YAML";
        }
        return std::string("is a robot in ") + (is_robot ? "URDF" : "SDF") + ": expected a robot file in YAML (" +
               std::string(urdf_keys) +
               "); `downwash robot import FILE -o robot.yaml` makes one in space, and docs/robot_files.md has an "
               "example";
    }
    if (has_ending(file, tables) || (std::ranges::any_of(line, is_letter) && line.find(':') == std::string_view::npos &&
                                     line.find_first_of(",;\t") != std::string_view::npos)) {
        return "is a table: expected YAML" +
               (is_thrust_stand(line) ? "; " + std::string(thrust_stand_keys) : std::string());
    }
    return {};
}

}  // namespace downwash::problems
