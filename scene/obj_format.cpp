#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "downwash/base/text.hpp"
#include "downwash/scene/foreign_file.hpp"

namespace downwash::foreign {
namespace {

constexpr std::size_t max_vertices = 3 * max_pieces;

// Statements of the Wavefront specification (Appendix B1 of the Advanced Visualizer manual) that do not add a surface.
constexpr std::array<std::string_view, 19> passed_over{
    "vt",     "vn",    "vp",       "g",        "o",   "s",          "mg",        "usemtl", "mtllib", "usemap",
    "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "l",      "p"};

// Those that do, or may (call, csh), and are not read.
constexpr std::array<std::string_view, 20> not_read{"cstype", "deg",   "bmat", "step", "curv", "curv2", "surf",
                                                    "parm",   "trim",  "hole", "scrv", "sp",   "end",   "con",
                                                    "ctech",  "stech", "bzp",  "bsp",  "call", "csh"};

template <std::size_t count>
bool contains(const std::array<std::string_view, count>& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::optional<std::int64_t> parse_index(std::string_view text) {
    const auto index = parse_number<std::int64_t>(text);
    return index == std::int64_t{0} ? std::nullopt : index;
}

/// What follows an index and its slash: t, /n or t/n.
bool is_texture_or_normal(std::string_view text) {
    const std::size_t slash = text.find('/');
    return (slash == 0 || parse_index(text.substr(0, slash))) &&
           (slash == std::string_view::npos || parse_index(text.substr(slash + 1)));
}

class Obj {
 public:
    Obj(std::string_view text, const std::string& name) : lines_(text, name) {}

    TriangleMesh read() {
        while (lines_.next()) {
            const std::string_view statement = lines_.words()[0];
            if (statement == "v") {
                read_vertex();
            } else if (statement == "f" || statement == "fo") {
                read_face();
            } else if (contains(not_read, statement)) {
                lines_.fail("'" + std::string(statement) +
                            "' is not read, and a surface may depend on it: expected polygons, 'f', only");
            } else if (!statement.starts_with('#') && !contains(passed_over, statement)) {
                lines_.fail("found '" + excerpt(statement) + "', expected a statement like 'v' or 'f'");
            }
        }
        return std::move(mesh_);
    }

 private:
    /// v x y z, and perhaps a weight, a colour or both.
    void read_vertex() {
        const auto& words = lines_.words();
        const std::size_t numbers = words.size() - 1;
        if (numbers != 3 && numbers != 4 && numbers != 6 && numbers != 7) {
            lines_.fail("a vertex of " + std::to_string(numbers) + " numbers: expected 3");
        }
        if (mesh_.vertices_m.size() >= max_vertices) {
            lines_.fail("too many vertices: expected at most 6000000");
        }
        for (std::size_t i = 4; i < words.size(); ++i) {
            static_cast<void>(lines_.coordinate(words[i]));
        }
        mesh_.vertices_m.push_back(
            {lines_.coordinate(words[1]), lines_.coordinate(words[2]), lines_.coordinate(words[3])});
    }

    void read_face() {
        const auto& words = lines_.words();
        if (words.size() < 4) {
            lines_.fail("a face of " + std::to_string(words.size() - 1) + " corners: expected at least 3");
        }
        if (mesh_.triangles.size() + words.size() - 3 > max_pieces) {
            lines_.fail("more triangles than expected, which is at most " + std::to_string(max_pieces));
        }
        const std::uint32_t first = vertex_of(words[1]);
        std::uint32_t before = vertex_of(words[2]);
        for (std::size_t i = 3; i < words.size(); ++i) {
            const std::uint32_t next = vertex_of(words[i]);
            mesh_.triangles.push_back({first, before, next});
            before = next;
        }
    }

    /// The vertex of a corner i, i/t, i//n or i/t/n. Indices count from 1, negative ones back from the latest.
    [[nodiscard]] std::uint32_t vertex_of(std::string_view corner) const {
        const std::size_t slash = corner.find('/');
        const auto index = parse_index(corner.substr(0, slash));
        if (!index || (slash != std::string_view::npos && !is_texture_or_normal(corner.substr(slash + 1)))) {
            lines_.fail("found '" + excerpt(corner) + "', expected a corner as i, i/t, i//n or i/t/n, none of them 0");
        }
        const auto known = static_cast<std::int64_t>(mesh_.vertices_m.size());
        if (*index > known || *index < -known) {
            lines_.fail("refers to vertex " + std::to_string(*index) + ": expected one of the " +
                        std::to_string(known) + " before this line");
        }
        return static_cast<std::uint32_t>(*index > 0 ? *index - 1 : known + *index);
    }

    Lines lines_;
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& name) {
    return Obj(text, name).read();
}

}  // namespace downwash::foreign
