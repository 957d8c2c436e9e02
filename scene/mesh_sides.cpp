#include "downwash/scene/mesh_sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "downwash/scene/mesh_edges.hpp"

namespace downwash {
namespace {

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// The triangle across a side, when it is the only one there.
struct Neighbour {
    std::uint32_t triangle = nobody;
    bool disagrees = false;  ///< goes along the common edge the same way
};

/// Which piece each triangle belongs to, by the number of one triangle of it; nobody for those without edges.
std::vector<std::uint32_t> pieces_of(const std::vector<Edge>& edges, std::size_t triangle_count) {
    std::vector<std::uint32_t> piece(triangle_count);
    std::iota(piece.begin(), piece.end(), 0U);
    const auto root = [&piece](std::uint32_t t) {
        while (piece[t] != t) {
            piece[t] = piece[piece[t]];
            t = piece[t];
        }
        return t;
    };
    std::vector<bool> has_edges(triangle_count);
    for_all_edges(edges, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            has_edges[edges[i].triangle()] = true;
            const auto [low, high] = std::minmax({root(edges[first].triangle()), root(edges[i].triangle())});
            piece[high] = low;
        }
    });
    for (std::uint32_t t = 0; t < triangle_count; ++t) {
        piece[t] = root(t);
    }
    for (std::uint32_t t = 0; t < triangle_count; ++t) {
        piece[t] = has_edges[t] ? piece[t] : nobody;
    }
    return piece;
}

/// What is to be known of a piece to judge it.
struct Piece {
    bool is_piece = false;       ///< else the number is not that of a piece
    std::size_t open_edges = 0;  ///< at which an odd number of triangles meets
    bool is_turning = false;     ///< along some edge the triangles go more often one way than the other

    [[nodiscard]] bool has_rim() const noexcept { return open_edges > 0; }
};

/// By the numbers of pieces_of(). @param is_turned which triangles are the other way around
std::vector<Piece> judged(const std::vector<Edge>& edges, const std::vector<std::uint32_t>& piece_of,
                          const std::vector<bool>& is_turned) {
    std::vector<Piece> pieces(piece_of.size());
    for_all_edges(edges, [&](std::size_t first, std::size_t last) {
        int balance = 0;
        for (std::size_t i = first; i < last; ++i) {
            balance += edges[i].is_upward != is_turned[edges[i].triangle()] ? 1 : -1;
        }
        Piece& piece = pieces[piece_of[edges[first].triangle()]];
        piece.is_piece = true;
        piece.open_edges += (last - first) % 2;
        piece.is_turning = piece.is_turning || balance != 0;
    });
    return pieces;
}

/// Which triangles have the same corners as one before them, and which pieces have nothing but faces of two sides: of
/// each set of equal triangles as many go one way as the other.
struct Repetition {
    std::vector<bool> is_repeated;
    std::vector<bool> is_two_sided;  ///< by the numbers of pieces_of()
};

Repetition repetition_in(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner,
                         const std::vector<std::uint32_t>& piece_of) {
    struct Face {
        std::array<std::uint32_t, 3> corners;
        std::uint32_t triangle;
        int sense;
    };
    const std::size_t count = surface.triangles.size();
    std::vector<Face> faces;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (piece_of[t] == nobody) {
            continue;
        }
        const auto& [a, b, c] = surface.triangles[t];
        Face face{{corner[a], corner[b], corner[c]}, t, 1};
        for (const auto& [i, k] : {std::pair(0U, 1U), std::pair(1U, 2U), std::pair(0U, 1U)}) {
            if (face.corners[k] < face.corners[i]) {
                std::swap(face.corners[i], face.corners[k]);
                face.sense = -face.sense;
            }
        }
        faces.push_back(face);
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return std::tie(a.corners, a.triangle) < std::tie(b.corners, b.triangle);
    });
    Repetition found{std::vector<bool>(count), std::vector<bool>(count, true)};
    for (std::size_t first = 0; first < faces.size();) {
        int sense = 0;
        std::size_t i = first;
        for (; i < faces.size() && faces[i].corners == faces[first].corners; ++i) {
            found.is_repeated[faces[i].triangle] = i > first;
            sense += faces[i].sense;
        }
        if (sense != 0) {
            found.is_two_sided[piece_of[faces[first].triangle]] = false;
        }
        first = i;
    }
    return found;
}

/// Whether some triangle may have the corners of another: then more than two meet at its edges, or they are a piece.
bool may_repeat(const std::vector<Edge>& edges, const std::vector<std::uint32_t>& piece_of) {
    if (!all_edges(edges, [](std::size_t first, std::size_t last) { return last - first <= 2; })) {
        return true;
    }
    std::vector<unsigned char> size(piece_of.size());
    for (const std::uint32_t piece : piece_of) {
        if (piece != nobody && size[piece] < 3) {
            ++size[piece];
        }
    }
    return std::find(size.begin(), size.end(), 2) != size.end();
}

/// Which triangles are better left out because others are in their place.
std::vector<bool> left_out(const TriangleMesh& surface, const std::vector<std::uint32_t>& corner,
                           const std::vector<Edge>& edges, const std::vector<std::uint32_t>& piece_of) {
    const Repetition repetition = repetition_in(surface, corner, piece_of);
    const std::vector<bool> unturned(piece_of.size());
    std::vector<Edge> single;
    std::copy_if(edges.begin(), edges.end(), std::back_inserter(single),
                 [&](const Edge& edge) { return !repetition.is_repeated[edge.triangle()]; });
    const std::vector<Piece> all = judged(edges, piece_of, unturned);
    const std::vector<Piece> once = judged(single, piece_of, unturned);
    std::vector<bool> is_left_out(piece_of.size());
    for (std::size_t t = 0; t < piece_of.size(); ++t) {
        const std::uint32_t piece = piece_of[t];
        if (!repetition.is_repeated[t] || piece == nobody) {
            continue;
        }
        is_left_out[t] = repetition.is_two_sided[piece] || once[piece].open_edges < all[piece].open_edges ||
                         (all[piece].is_turning && !once[piece].has_rim());
    }
    return is_left_out;
}

/// By side of triangle.
std::vector<Neighbour> neighbours_of(const std::vector<Edge>& edges, std::size_t triangle_count) {
    std::vector<Neighbour> neighbours(3 * triangle_count);
    for_all_edges(edges, [&](std::size_t first, std::size_t last) {
        if (last - first == 2) {
            const Edge& a = edges[first];
            const Edge& b = edges[first + 1];
            const bool disagrees = a.is_upward == b.is_upward;
            neighbours[a.side] = {b.triangle(), disagrees};
            neighbours[b.side] = {a.triangle(), disagrees};
        }
    });
    return neighbours;
}

/// Which triangles are turned so that neighbours agree.
struct Turning {
    std::vector<bool> is_turned;
    double largest_share = 0;  ///< of the triangles of a connected part
};

/// Turns triangles until neighbours agree. Where they cannot, some edge stays out of balance.
Turning turned_to_agree(const std::vector<Neighbour>& neighbours) {
    const std::size_t count = neighbours.size() / 3;
    Turning turning;
    std::vector<bool>& is_turned = turning.is_turned;
    is_turned.resize(count);
    std::vector<bool> is_reached(count);
    std::vector<std::uint32_t> part;  // the connected triangles around one, in the order in which they are reached
    for (std::uint32_t start = 0; start < count; ++start) {
        if (is_reached[start]) {
            continue;
        }
        is_reached[start] = true;
        part.assign(1, start);
        std::size_t turned_count = 0;
        for (std::size_t next = 0; next < part.size(); ++next) {
            const std::uint32_t triangle = part[next];
            turned_count += is_turned[triangle] ? 1 : 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const Neighbour& other = neighbours[3 * triangle + i];
                if (other.triangle != nobody && !is_reached[other.triangle]) {
                    is_reached[other.triangle] = true;
                    is_turned[other.triangle] = is_turned[triangle] != other.disagrees;
                    part.push_back(other.triangle);
                }
            }
        }
        if (2 * turned_count > part.size()) {
            for (const std::uint32_t triangle : part) {
                is_turned[triangle] = !is_turned[triangle];
            }
            turned_count = part.size() - turned_count;
        }
        turning.largest_share =
            std::max(turning.largest_share, static_cast<double>(turned_count) / static_cast<double>(part.size()));
    }
    return turning;
}

/// What a piece encloses, around one of its corners.
struct Enclosed {
    Vector3 origin{};
    bool has_origin = false;
    double area = 0;
    double volume = 0;
    Vector3 moment{};  ///< volume times its centroid

    void add(const Vector3& first, const Vector3& second, const Vector3& third) {
        if (!std::exchange(has_origin, true)) {
            origin = first;
        }
        const Vector3 a = first - origin, b = second - origin, c = third - origin;
        const Vector3 normal = cross(b - a, c - a);
        const double part = dot(a, cross(b, c)) / 6;
        area += std::sqrt(dot(normal, normal)) / 2;
        volume += part;
        moment = moment + 0.25 * part * (a + b + c);
    }

    /// Both vanish, up to coordinates of single precision; a solid that crosses itself may have no volume by its signs.
    [[nodiscard]] bool is_flat() const {
        constexpr double rounding = 1e-8;
        return std::abs(volume) <= rounding * area * std::sqrt(area) &&
               std::sqrt(dot(moment, moment)) <= rounding * area * area;
    }
};

/// Which pieces without a rim enclose nothing, by the numbers of pieces_of().
std::vector<bool> flat_pieces(const TriangleMesh& surface, const MeshSides& sides,
                              const std::vector<std::uint32_t>& piece_of, const std::vector<Piece>& pieces) {
    std::vector<Enclosed> enclosed(pieces.size());
    for (std::size_t t = 0; t < piece_of.size(); ++t) {
        if (piece_of[t] != nobody && !sides.is_sheet[t] && !sides.is_repeated[t]) {
            const auto& [a, b, c] = surface.triangles[t];
            const bool is_turned = sides.is_turned[t];
            enclosed[piece_of[t]].add(surface.vertices_m[a], surface.vertices_m[is_turned ? c : b],
                                      surface.vertices_m[is_turned ? b : c]);
        }
    }
    std::vector<bool> is_flat(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        is_flat[i] = enclosed[i].has_origin && enclosed[i].is_flat();
    }
    return is_flat;
}

/// Counts pieces and open edges. @param pieces judged(), by the numbers of `piece_of`
SurfaceFacts facts_of(const TriangleMesh& surface, const std::vector<Edge>& edges,
                      const std::vector<std::uint32_t>& piece_of, const std::vector<Piece>& pieces) {
    SurfaceFacts facts;
    for (const Piece& piece : pieces) {
        facts.pieces += piece.is_piece ? 1 : 0;
        facts.solid_pieces += piece.is_piece && !piece.has_rim() ? 1 : 0;
    }
    std::uint32_t first_side = nobody;
    for_all_edges(edges, [&](std::size_t first, std::size_t last) {
        if ((last - first) % 2 != 0 && pieces[piece_of[edges[first].triangle()]].has_rim()) {
            ++facts.open_edges;
            if (edges[first].side < first_side) {
                first_side = edges[first].side;
                const Vector3& low = surface.vertices_m[edges[first].low];
                facts.open_place = low + 0.5 * (surface.vertices_m[edges[first].high] - low);
            }
        }
    });
    return facts;
}

}  // namespace

MeshSides sides_of(const TriangleMesh& surface) {
    const std::size_t count = surface.triangles.size();
    const std::vector<std::uint32_t> corner = first_corners(surface.vertices_m);
    std::vector<Edge> edges = sorted_edges(surface, corner);
    const std::vector<std::uint32_t> piece_of = pieces_of(edges, count);
    MeshSides sides;
    sides.is_turned.resize(count);
    sides.is_sheet.resize(count);
    sides.is_repeated.resize(count);
    if (may_repeat(edges, piece_of)) {
        sides.is_repeated = left_out(surface, corner, edges, piece_of);
        std::erase_if(edges, [&](const Edge& edge) { return sides.is_repeated[edge.triangle()]; });
    }
    std::vector<Piece> pieces = judged(edges, piece_of, sides.is_turned);
    sides.facts = facts_of(surface, edges, piece_of, pieces);
    for (std::size_t t = 0; t < count; ++t) {
        sides.is_sheet[t] = piece_of[t] != nobody && pieces[piece_of[t]].has_rim();
    }
    std::erase_if(edges, [&](const Edge& edge) { return sides.is_sheet[edge.triangle()]; });
    const auto turns = [](const Piece& piece) { return piece.is_turning; };
    const auto is_contradictory = [&](const std::vector<bool>& is_turned) {
        pieces = judged(edges, piece_of, is_turned);
        return std::any_of(pieces.begin(), pieces.end(), turns);
    };
    if (is_contradictory(sides.is_turned)) {
        Turning turning = turned_to_agree(neighbours_of(edges, count));
        sides.is_turned = std::move(turning.is_turned);
        sides.most_turned = turning.largest_share;
        if (is_contradictory(sides.is_turned)) {
            sides.kind = SurfaceKind::contradictory;
            return sides;
        }
    }
    SurfaceFacts& facts = sides.facts;
    const std::vector<bool> is_flat = flat_pieces(surface, sides, piece_of, pieces);
    facts.solid_pieces -= static_cast<std::size_t>(std::count(is_flat.begin(), is_flat.end(), true));
    for (std::size_t t = 0; t < count; ++t) {
        sides.is_sheet[t] = sides.is_sheet[t] || (piece_of[t] != nobody && is_flat[piece_of[t]]);
    }
    sides.kind = facts.solid_pieces == facts.pieces ? SurfaceKind::solid
                 : facts.solid_pieces == 0          ? SurfaceKind::sheet
                                                    : SurfaceKind::mixed;
    return sides;
}

}  // namespace downwash
