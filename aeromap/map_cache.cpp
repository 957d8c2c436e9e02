#include "downwash/aeromap/map_cache.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <map>
#include <string_view>

#include "downwash/base/files.hpp"
#include "downwash/base/sha256.hpp"

// A file of the cache: a head that says what it is, the bytes of some blocks of a map, and the SHA-256 of both. Its
// name: the map's key, a dash, and the beginning of the digest, so that programs that write the same write the same
// file.

namespace downwash {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_maps = 32;
/// As many files of one map are merged.
constexpr std::size_t many_files = 8;
constexpr std::uintmax_t max_bytes = 1'000'000'000;
constexpr std::size_t digest_letters = 64;
constexpr std::size_t letters_in_name = 16;  // of the digest
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

/// The files of a map.
std::vector<fs::path> files_of(const fs::path& folder, const std::string& key) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(key + '-') && name.ends_with(extension)) {
            files.push_back(entry.path());
        }
    }
    return files;
}

/// Writes some blocks of a map; the name of their file.
fs::path write_blocks(const fs::path& folder, const std::string& key, const std::string& blocks) {
    std::string file = head_of(key) + blocks;
    const std::string digest = sha256_hex(file);
    file += digest;
    fs::path path = folder / (key + '-' + digest.substr(0, letters_in_name) + std::string(extension));
    write_file(path, file);
    return path;
}

std::string key_of(const AeroMap& map) {
    return map_key(map.layers(), map.plane(), map.extent());
}
std::string key_of(const VolumeMap& map) {
    return map_key(map);
}

/// A map of the same making of which nothing is filled.
AeroMap unfilled(const AeroMap& map) {
    return AeroMap(map.layers(), map.plane(), map.extent());
}
VolumeMap unfilled(const VolumeMap& map) {
    return map.unfilled();
}

/// Adds the blocks of a file to a map; false if it is not a sound file of this map.
template <class Map>
bool read_blocks(const fs::path& path, const std::string& key, Map& map) {
    try {
        const std::string file = read_file(path, max_bytes);
        return map.add_bytes(checked_content(file, head_of(key)));
    } catch (const std::exception&) {
        return false;
    }
}

/// Replaces the files of a map by one. What another program adds meanwhile stays beside it, and what it merges at the
/// same time is in its file.
template <class Map>
void merge(const fs::path& folder, const std::string& key, const Map& map) {
    Map all = unfilled(map);
    std::vector<fs::path> merged = files_of(folder, key);
    std::erase_if(merged, [&](const fs::path& path) { return !read_blocks(path, key, all); });
    const fs::path whole = write_blocks(folder, key, all.to_bytes());
    for (const fs::path& path : merged) {
        if (path != whole) {
            fs::remove(path);
        }
    }
}

/// A map in the cache, or what is called like one.
struct CachedMap {
    std::vector<fs::path> files;
    fs::file_time_type used = fs::file_time_type::min();
    std::uintmax_t bytes = 0;
};

/// Removes the maps that were not used for longest until the rest may stay, and what others left unfinished.
void trim(const fs::path& folder) {
    std::map<std::string, CachedMap> by_key;
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        const bool is_unfinished = name.ends_with(".part") && name.find(extension) != std::string::npos;
        std::error_code ignored;
        if (!entry.is_regular_file(ignored) || !(is_unfinished || name.ends_with(extension))) {
            continue;
        }
        std::error_code gone;  // another program may have removed it
        const fs::file_time_type used = entry.last_write_time(gone);
        const std::uintmax_t size = gone ? 0 : entry.file_size(gone);
        if (gone) {
            continue;
        }
        if (!is_unfinished) {
            CachedMap& map = by_key[name.substr(0, name.find_first_of("-."))];
            map.files.push_back(entry.path());
            map.used = std::max(map.used, used);
            map.bytes += size;
            bytes += size;
        } else if (used < fs::file_time_type::clock::now() - abandoned_after) {
            fs::remove(entry.path());
        }
    }
    std::vector<CachedMap> maps;
    maps.reserve(by_key.size());
    for (auto& [key, map] : by_key) {
        maps.push_back(std::move(map));
    }
    std::sort(maps.begin(), maps.end(), [](const CachedMap& a, const CachedMap& b) { return a.used < b.used; });
    for (std::size_t oldest = 0; maps.size() - oldest > max_maps || bytes > max_bytes; ++oldest) {
        for (const fs::path& path : maps[oldest].files) {
            fs::remove(path);
        }
        bytes -= maps[oldest].bytes;
    }
}

/// Adds all that a folder has of a map; false if there is nothing.
template <class Map>
bool read_all(const fs::path& folder, Map& map) {
    const std::string key = key_of(map);
    bool is_found = false;
    for (const fs::path& path : files_of(folder, key)) {
        if (read_blocks(path, key, map)) {
            is_found = true;
            std::error_code ignored;
            fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
        }
    }
    return is_found;
}

template <class Map>
bool keep_new(const fs::path& folder, const Map& map) {
    const std::string blocks = map.take_new_bytes();
    if (blocks.empty()) {
        return true;
    }
    if (blocks.size() > max_bytes / 2) {
        return false;
    }
    const std::string key = key_of(map);
    fs::create_directories(folder);
    write_blocks(folder, key, blocks);
    if (files_of(folder, key).size() >= many_files) {
        merge(folder, key, map);
    }
    trim(folder);
    return true;
}

}  // namespace

std::shared_ptr<const AeroMap> MapCache::find(const std::vector<MapLayer>& layers, const PlaneOfMotion& plane,
                                              const Bounds& extent) const noexcept {
    try {
        auto map = std::make_shared<AeroMap>(layers, plane, extent);
        return read_all(folder_, *map) ? map : nullptr;
    } catch (const std::exception&) {
        return nullptr;
    }
}

bool MapCache::keep(const AeroMap& map) const noexcept {
    try {
        return keep_new(folder_, map);
    } catch (const std::exception&) {
        return false;
    }
}

bool MapCache::read(VolumeMap& map) const noexcept {
    try {
        return read_all(folder_, map);
    } catch (const std::exception&) {
        return false;
    }
}

bool MapCache::keep(const VolumeMap& map) const noexcept {
    try {
        return keep_new(folder_, map);
    } catch (const std::exception&) {
        return false;
    }
}

std::shared_ptr<const AeroMap> cached_map(const fs::path& folder, const std::vector<MapLayer>& layers,
                                          const PlaneOfMotion& plane, const Bounds& extent) {
    if (!folder.empty()) {
        if (auto map = MapCache(folder).find(layers, plane, extent)) {
            return map;
        }
    }
    return std::make_shared<const AeroMap>(layers, plane, extent);
}

void keep_map(const fs::path& folder, const AeroMap& map) noexcept {
    if (!folder.empty()) {
        MapCache(folder).keep(map);
    }
}

}  // namespace downwash
