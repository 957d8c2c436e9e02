#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "downwash/base/export.hpp"

namespace downwash {

/// What a picture is stored as.
enum class PictureFormat {
    svg,  ///< vector graphics; fields inside are embedded as images
    png,
    pdf,  ///< vector graphics on one page; 96 pixels are an inch
};

/// How a figure becomes a picture. The height follows from what is drawn.
struct PictureSettings {
    PictureFormat format = PictureFormat::svg;
    int width_px = 1200;  ///< from least_picture_width_px to most_picture_width_px
};

/// Least PictureSettings::width_px.
inline constexpr int least_picture_width_px = 400;
/// Greatest PictureSettings::width_px.
inline constexpr int most_picture_width_px = 8000;

/// The format that a file's extension asks for, .svg, .png or .pdf in any case; empty for any other.
[[nodiscard]] DOWNWASH_EXPORT std::optional<PictureFormat> picture_format_of(const std::filesystem::path& file);

/// A picture cannot be drawn on this machine: gnuplot is missing or failed. what() says why and what to do about it.
struct DOWNWASH_EXPORT PictureError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// An opaque colour, sRGB.
struct Color {
    std::uint8_t red = 0, green = 0, blue = 0;
    bool operator==(const Color&) const = default;
};

/// A point of the plane of motion.
struct PlanePoint {
    double x_m = 0, z_m = 0;
};

}  // namespace downwash
