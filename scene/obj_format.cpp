#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "downwash/base/text.hpp"
#include "downwash/scene/foreign_file.hpp"
#include "downwash/scene/polygon_triangles.hpp"

namespace downwash::foreign {
namespace {

constexpr std::size_t max_vertices = 3 * max_pieces;

/// All faces of a file take at most so many comparisons to cut: some twenty seconds.
constexpr std::size_t max_comparisons = 10 * max_face_comparisons;

/// Faces that are bent by more, in their sizes, are worth a remark.
constexpr double noted_bend = 0.01;

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

/// What follows an index and its slash: t, /n, t/n, each of which may be missing or 0. Nobody uses them.
bool is_texture_or_normal(std::string_view text) {
    const auto is_whole = [](std::string_view part) { return part.empty() || parse_number<std::int64_t>(part); };
    const std::size_t slash = text.find('/');
    return is_whole(text.substr(0, slash)) && (slash == std::string_view::npos || is_whole(text.substr(slash + 1)));
}

/// What is wrong with a face.
std::string text_of(FaceFault fault) {
    switch (fault) {
        case FaceFault::bent:
            return "that is not plane: expected corners within 0.05 of its size from a plane; cut it into triangles";
        case FaceFault::crossing:
            return "whose outline crosses itself: expected one that goes once around; cut it into triangles";
        case FaceFault::too_large:
            return "that is neither convex nor small: expected at most " + std::to_string(max_concave_corners) +
                   " corners; cut it into triangles";
        case FaceFault::none:
            break;
    }
    return "";
}

/// Whether corners repeat from some corner on what they were from the first: two or more turns around the same outline.
bool goes_around_again(const std::vector<std::uint32_t>& face) {
    const auto second = std::find(face.begin() + 1, face.end(), face.front());
    const auto turn = static_cast<std::size_t>(second - face.begin());
    return second != face.end() && face.size() % turn == 0 &&
           std::equal(second, face.end(), face.begin(), face.end() - static_cast<std::ptrdiff_t>(turn));
}

class Obj {
 public:
    Obj(std::string_view text, const std::string& name) : lines_(text, name, Lines::Continuation::backslash) {}

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
            } else if (!contains(passed_over, statement)) {
                if (is_padding(lines_.rest_with_line())) {
                    mesh_.remarks.push_back("line " + std::to_string(lines_.number()) +
                                            ": the file ends with bytes that are no text, which are ignored");
                    break;
                }
                lines_.fail("found '" + excerpt(statement) + "', expected a statement like 'v' or 'f'");
            }
        }
        if (bent_faces_ > 0) {
            mesh_.remarks.push_back(
                std::to_string(bent_faces_) +
                (bent_faces_ == 1 ? " face is not plane, in line " : " faces are not plane, the first in line ") +
                std::to_string(first_bent_line_) + ": where such a face is cut into triangles is a choice");
        }
        return std::move(mesh_);
    }

 private:
    /// v x y z, and perhaps a weight, a colour of three or four numbers, or both, which nobody uses.
    void read_vertex() {
        const auto& words = lines_.words();
        const std::size_t numbers = words.size() - 1;
        if (numbers < 3 || numbers == 5 || numbers > 8) {
            lines_.fail("a vertex of " + std::to_string(numbers) + " numbers: expected 3");
        }
        if (mesh_.vertices_m.size() >= max_vertices) {
            lines_.fail("too many vertices: expected at most 6000000");
        }
        mesh_.vertices_m.push_back(
            {lines_.coordinate(words[1]), lines_.coordinate(words[2]), lines_.coordinate(words[3])});
    }

    void read_face() {
        const auto& words = lines_.words();
        if (words.size() < 4) {
            const std::size_t count = words.size() - 1;
            lines_.fail("a face of " + std::to_string(count) + (count == 1 ? " corner" : " corners") +
                        ": expected at least 3");
        }
        if (mesh_.triangles.size() + words.size() - 3 > max_pieces) {
            lines_.fail("more triangles than expected, which is at most " + std::to_string(max_pieces));
        }
        face_.clear();
        corners_.clear();
        for (std::size_t i = 1; i < words.size(); ++i) {
            face_.push_back(vertex_of(words[i]));
            corners_.push_back(mesh_.vertices_m[face_.back()]);
        }
        if (goes_around_again(face_)) {
            lines_.fail("a face whose outline goes around more than once: expected each corner once");
        }
        const FaceCut cut = cut_face(corners_, std::min(max_face_comparisons, comparisons_left_));
        if (cut.comparisons > comparisons_left_) {
            lines_.fail("a face of " + std::to_string(face_.size()) +
                        " corners that is not convex, behind others that took long to cut into triangles: expected "
                        "fewer corners of such faces in one file; cut them into triangles");
        }
        comparisons_left_ -= cut.comparisons;
        if (cut.fault != FaceFault::none) {
            lines_.fail("a face of " + std::to_string(face_.size()) + " corners " + text_of(cut.fault));
        }
        if (cut.bend > noted_bend) {
            first_bent_line_ = bent_faces_++ == 0 ? lines_.number() : first_bent_line_;
        }
        for (const auto& [a, b, c] : cut.triangles) {
            mesh_.triangles.push_back({face_[a], face_[b], face_[c]});
        }
    }

    /// The vertex of a corner i, i/t, i//n or i/t/n, the numbers behind a slash optional. Indices count from 1,
    /// negative ones back from the latest.
    [[nodiscard]] std::uint32_t vertex_of(std::string_view corner) const {
        const std::size_t slash = corner.find('/');
        const auto index = parse_index(corner.substr(0, slash));
        if (!index || (slash != std::string_view::npos && !is_texture_or_normal(corner.substr(slash + 1)))) {
            lines_.fail("found '" + excerpt(corner) +
                        "', expected a corner as i, i/t, i//n or i/t/n, with i other than 0");
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
    std::vector<std::uint32_t> face_;  ///< the vertices of the current face
    std::vector<Vector3> corners_;     ///< and where they are
    std::size_t comparisons_left_ = max_comparisons;
    std::size_t bent_faces_ = 0;
    std::size_t first_bent_line_ = 0;
};

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& name) {
    return Obj(text_of(text, name), name).read();
}

}  // namespace downwash::foreign
