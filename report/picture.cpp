#include "downwash/report/picture.hpp"

#include <algorithm>
#include <string>

namespace downwash {

std::optional<PictureFormat> picture_format_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (extension == ".svg") {
        return PictureFormat::svg;
    }
    if (extension == ".png") {
        return PictureFormat::png;
    }
    if (extension == ".pdf") {
        return PictureFormat::pdf;
    }
    return std::nullopt;
}

}  // namespace downwash
