#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// The file format of a picture.
enum class PictureFormat {
    svg,  ///< vector graphics; fields inside are embedded as images
    png,
    pdf,  ///< vector graphics on one page; 96 pixels are an inch
};

/// Settings for drawing a figure. The height follows from the content.
struct PictureSettings {
    PictureFormat format = PictureFormat::svg;
    int width_px = 1200;  ///< from min_picture_width_px to max_picture_width_px
    int threads = 1;      ///< at least 1; the picture does not depend on it
};

/// Limits of PictureSettings::width_px.
inline constexpr int min_picture_width_px = 400, max_picture_width_px = 8000;

/// The format that a file's extension asks for, .svg, .png or .pdf in any case; empty for any other.
[[nodiscard]] DOWNWASH_EXPORT std::optional<PictureFormat> picture_format_of(const std::filesystem::path& file);

/// A picture cannot be drawn on this machine: gnuplot is missing or failed. what() gives the reason and a remedy.
struct DOWNWASH_EXPORT PictureError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An opaque colour, sRGB.
struct Color {
    std::uint8_t red = 0, green = 0, blue = 0;
    bool operator==(const Color&) const = default;
};

/// The colour 0xRRGGBB.
[[nodiscard]] constexpr Color color_of(std::uint32_t rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16U), static_cast<std::uint8_t>(rgb >> 8U & 0xFFU),
            static_cast<std::uint8_t>(rgb & 0xFFU)};
}

/// A point of the plane of motion.
struct PlanePoint {
    double x_m = 0, z_m = 0;
};

/// The corners of a polygon, without repeating the first one, or the points of a line.
using Ring = std::vector<PlanePoint>;

/// A range of an axis.
struct AxisRange {
    double low = 0, high = 1;
};

}  // namespace downwash
