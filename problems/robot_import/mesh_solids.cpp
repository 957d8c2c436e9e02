#include "downwash/robot_import/mesh_solids.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/mesh_pieces.hpp"

namespace downwash::robot_import {
namespace {

using Points = std::vector<Vector3>;

/// More pieces are joined with the one nearest in the file before any are compared.
constexpr std::size_t most_compared = 200;
/// A group is joined with another one if the box around both has at most so much of the volume of both boxes.
constexpr double little_more = 1.3;
/// Of the longest extent: what is thinner counts as that thick.
constexpr double least_thickness = 0.002;

/// Points that stand for a piece, and the volume of the box around them.
struct Group {
    Points points;
    double volume = 0;
};

/// The volume of the box along the principal axes of some points. @param least_m of its edges
double box_volume(const Points& one, const Points& other, double least_m) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    const auto for_all = [&](const auto& use) {
        for (const Points* points : {&one, &other}) {
            for (const Vector3& point : *points) {
                use(Eigen::Map<const Eigen::Vector3d>(point.data()));
            }
        }
    };
    for_all([&](const auto& point) {
        sum += point;
        squares += point * point.transpose();
    });
    const auto count = static_cast<double>(one.size() + other.size());
    const Eigen::Matrix3d spread = squares / count - (sum / count) * (sum / count).transpose();
    const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
    Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for_all([&](const auto& point) {
        const Eigen::Vector3d at = axes.transpose() * point;
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
    });
    return (high - low).cwiseMax(least_m).prod();
}

/// A few points that stand for a piece where only its box matters: those that are farthest along some directions.
Points outline_of(const Points& points) {
    constexpr std::size_t few = 60;
    if (points.size() <= few) {
        return points;
    }
    Points outline;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                const Vector3 direction{1.0 * x, 1.0 * y, 1.0 * z};
                outline.push_back(*std::ranges::max_element(
                    points, {}, [&direction](const Vector3& point) { return dot(point, direction); }));
            }
        }
    }
    return outline;
}

double longest_extent(const std::vector<Points>& pieces) {
    Vector3 low = pieces[0][0], high = low;
    for (const Points& piece : pieces) {
        for (const Vector3& point : piece) {
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], point[k]);
                high[k] = std::max(high[k], point[k]);
            }
        }
    }
    return length_of(high - low);
}

void append(Points& to, const Points& more) {
    to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

void read_meshes(KinematicTree& tree) {
    for (TreeLink& link : tree.links) {
        for (TreeShape& shape : link.collision.empty() ? link.visual : link.collision) {
            auto* mesh = std::get_if<MeshReference>(&shape.form);
            if (mesh == nullptr || !mesh->is_resolved || !mesh->pieces.empty()) {
                continue;
            }
            try {
                mesh->pieces = connected_pieces(*read_mesh(mesh->file));
            } catch (const InputError&) {
                // Said where its shape is needed.
            }
        }
    }
}

std::vector<Points> joined_pieces(std::vector<Points> pieces) {
    if (pieces.size() < 2) {
        return pieces;
    }
    while (pieces.size() > most_compared) {
        // Neighbours in the file are mostly neighbours in space.
        std::vector<Points> fewer;
        for (std::size_t i = 0; i < pieces.size(); i += 2) {
            fewer.push_back(std::move(pieces[i]));
            if (i + 1 < pieces.size()) {
                append(fewer.back(), pieces[i + 1]);
            }
        }
        pieces = std::move(fewer);
    }
    const double least_m = least_thickness * longest_extent(pieces);
    std::vector<Group> outlines;
    for (const Points& piece : pieces) {
        outlines.push_back({outline_of(piece), 0});
        outlines.back().volume = box_volume(outlines.back().points, {}, least_m);
    }
    const auto both = [&](std::size_t i, std::size_t k) {
        return box_volume(outlines[i].points, outlines[k].points, least_m);
    };
    std::vector<std::vector<double>> together(pieces.size(), std::vector<double>(pieces.size(), 0));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            together[i][k] = both(i, k);
        }
    }
    bool is_forced = false;  // groups that hold much space between them would join all others
    while (pieces.size() > (is_forced ? most_groups : 1)) {
        std::size_t one = 0, other = 0;
        double least_more = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                const double apart = outlines[i].volume + outlines[k].volume, more = together[i][k] - apart;
                if ((is_forced || together[i][k] <= little_more * apart) && more < least_more) {
                    least_more = more;
                    one = i;
                    other = k;
                }
            }
        }
        if (one == other) {
            if (is_forced) {
                break;  // numbers that are not finite
            }
            is_forced = true;
            continue;
        }
        append(pieces[other], pieces[one]);
        append(outlines[other].points, outlines[one].points);
        outlines[other].points = outline_of(outlines[other].points);
        outlines[other].volume = box_volume(outlines[other].points, {}, least_m);
        const auto gone = static_cast<std::ptrdiff_t>(one);
        pieces.erase(pieces.begin() + gone);
        outlines.erase(outlines.begin() + gone);
        together.erase(together.begin() + gone);
        for (std::vector<double>& row : together) {
            row.erase(row.begin() + gone);
        }
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (i != other) {
                together[std::max(i, other)][std::min(i, other)] = both(i, other);
            }
        }
    }
    return pieces;
}

}  // namespace downwash::robot_import
