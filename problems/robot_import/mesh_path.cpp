#include "downwash/robot_import/mesh_path.hpp"

#include <array>
#include <string_view>
#include <system_error>

namespace downwash::robot_import {
namespace {

namespace fs = std::filesystem;

/// A file of a package, in a folder or in those around it.
std::string in_package(std::string_view path, const fs::path& folder) {
    const std::string_view name = path.substr(0, path.find('/'));
    const std::string_view rest = name.size() < path.size() ? path.substr(name.size() + 1) : std::string_view();
    std::error_code error;
    for (fs::path around = folder;; around = around.parent_path()) {
        if (fs::exists(around / path, error)) {
            return (around / path).string();
        }
        if (around.filename() == name && fs::exists(around / rest, error)) {
            return (around / rest).string();
        }
        if (around.empty() || around == around.root_path()) {
            return {};
        }
    }
}

}  // namespace

std::string named_file(const std::string& uri, const fs::path& named_in) {
    std::string_view path = uri;
    std::error_code error;
    const fs::path folder = fs::absolute(named_in, error).parent_path();
    for (const std::string_view scheme : std::array<std::string_view, 2>{"package://", "model://"}) {
        if (path.starts_with(scheme)) {
            return in_package(path.substr(scheme.size()), folder);
        }
    }
    if (constexpr std::string_view scheme = "file://"; path.starts_with(scheme)) {
        path.remove_prefix(scheme.size());
    }
    const fs::path file = folder / path;
    return fs::exists(file, error) ? file.string() : std::string();
}

MeshReference mesh_reference(const std::string& uri, const fs::path& named_in) {
    MeshReference mesh;
    mesh.file = named_file(uri, named_in);
    std::error_code error;
    mesh.is_resolved = !mesh.file.empty() && fs::is_regular_file(mesh.file, error);
    if (!mesh.is_resolved) {
        mesh.file = uri;
    }
    return mesh;
}

}  // namespace downwash::robot_import
