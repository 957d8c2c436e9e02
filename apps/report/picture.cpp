#include "downwash/report/picture.hpp"

#include <string>

#include "downwash/base/text.hpp"

namespace downwash {

std::optional<PictureFormat> picture_format_of(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    return is_same_word(ending, ".svg")   ? std::optional(PictureFormat::svg)
           : is_same_word(ending, ".png") ? std::optional(PictureFormat::png)
           : is_same_word(ending, ".pdf") ? std::optional(PictureFormat::pdf)
                                          : std::nullopt;
}

}  // namespace downwash
