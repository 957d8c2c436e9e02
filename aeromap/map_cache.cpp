#include "downwash/aeromap/map_cache.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <string_view>

#include "downwash/base/files.hpp"
#include "downwash/base/sha256.hpp"

// A file of the cache: a head that says what it is, a map's bytes, and the SHA-256 of both.

namespace downwash {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_files = 32;
constexpr std::uintmax_t max_bytes = 1'000'000'000;
constexpr std::size_t digest_letters = 64;
constexpr std::string_view extension = ".aeromap";
/// A file that was not finished for so long never will be.
constexpr auto abandoned_after = std::chrono::hours(1);

/// "downwash aero map", the format, the byte order of this machine, the key.
std::string head_of(const std::string& key) {
    constexpr std::uint32_t byte_order = 0x01020304;
    std::string head = "downwash aero map " + std::to_string(map_format_version) + "\n";
    head.append(reinterpret_cast<const char*>(&byte_order), sizeof(byte_order));
    return head + key;
}

/// The map's bytes within those of a file; empty when it is damaged or not the file asked for.
std::string_view checked_content(std::string_view file, const std::string& head) {
    if (file.size() < head.size() + digest_letters || !file.starts_with(head)) {
        return {};
    }
    const std::string_view digested = file.substr(0, file.size() - digest_letters);
    return file.substr(digested.size()) == sha256_hex(digested) ? digested.substr(head.size()) : std::string_view();
}

struct CachedFile {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes;
};

/// Removes what was not used for longest until the rest may stay, and what others left unfinished.
void trim(const fs::path& folder) {
    std::vector<CachedFile> files;
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        const bool is_unfinished = name.ends_with(".part") && name.find(extension) != std::string::npos;
        if (!entry.is_regular_file() || !(is_unfinished || name.ends_with(extension))) {
            continue;
        }
        if (!is_unfinished) {
            files.push_back({entry.path(), entry.last_write_time(), entry.file_size()});
            bytes += files.back().bytes;
        } else if (entry.last_write_time() < fs::file_time_type::clock::now() - abandoned_after) {
            fs::remove(entry.path());
        }
    }
    std::sort(files.begin(), files.end(), [](const CachedFile& a, const CachedFile& b) { return a.used < b.used; });
    for (std::size_t oldest = 0; files.size() - oldest > max_files || bytes > max_bytes; ++oldest) {
        fs::remove(files[oldest].path);
        bytes -= files[oldest].bytes;
    }
}

}  // namespace

std::shared_ptr<const AeroMap> MapCache::find(const std::vector<MapLayer>& layers, const PlaneOfMotion& plane,
                                              const Bounds& extent) const noexcept {
    try {
        const std::string key = map_key(layers, plane, extent);
        const fs::path path = folder_ / (key + std::string(extension));
        const std::string file = read_file(path, max_bytes);
        const std::string_view content = checked_content(file, head_of(key));
        std::optional<AeroMap> map = AeroMap::from_bytes(layers, plane, extent, content);
        if (!map) {
            return nullptr;
        }
        std::error_code ignored;
        fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
        return std::make_shared<const AeroMap>(*std::move(map));
    } catch (const std::exception&) {
        return nullptr;
    }
}

bool MapCache::keep(const AeroMap& map) const noexcept {
    try {
        const std::string key = map_key(map.layers(), map.plane(), map.extent());
        std::string file = head_of(key) + map.to_bytes();
        file += sha256_hex(file);
        if (file.size() > max_bytes) {
            return false;
        }
        fs::create_directories(folder_);
        write_file(folder_ / (key + std::string(extension)), file);
        trim(folder_);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

std::shared_ptr<const AeroMap> cached_map(const fs::path& folder, const std::vector<MapLayer>& layers,
                                          const PlaneOfMotion& plane, const Bounds& extent, int threads,
                                          const std::function<void(double)>& on_progress,
                                          const StopCondition& is_over) {
    if (folder.empty()) {
        return std::make_shared<const AeroMap>(layers, plane, extent, threads, on_progress, is_over);
    }
    const MapCache cache(folder);
    if (auto map = cache.find(layers, plane, extent)) {
        return map;
    }
    auto map = std::make_shared<const AeroMap>(layers, plane, extent, threads, on_progress, is_over);
    cache.keep(*map);
    return map;
}

}  // namespace downwash
