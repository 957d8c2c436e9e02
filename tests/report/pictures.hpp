#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "../support/scratch_folder.hpp"
#include "downwash/report/picture.hpp"

namespace downwash::test {

/// The texts of a picture, one line each. Fails the test when it is not well-formed XML with an <svg> at its root.
[[nodiscard]] std::string svg_texts(const std::string& picture);

/// Those of a figure.
template <class Figure>
std::string texts_of(const Figure& figure, int width_px = 600) {
    return svg_texts(draw(figure, {PictureFormat::svg, width_px}));
}

/// Width and height that the head of a PNG file states; zeros when it is none.
[[nodiscard]] std::array<unsigned, 2> png_size(const std::string& picture);

/// The area of a ring, positive where it runs counter-clockwise.
[[nodiscard]] double area_of(const Ring& ring);

/// Texts that would run a command, end a string, or break a line, if anything let them. Each would leave the file
/// downwash-was-here in the current folder.
[[nodiscard]] const std::array<std::string, 13>& hostile_texts();

/// An empty folder to be in; it is gone with this, and the one before is back.
class WorkingFolder {
 public:
    WorkingFolder() : before_(std::filesystem::current_path()) { std::filesystem::current_path(folder_.path()); }
    ~WorkingFolder() {
        std::error_code ignored;
        std::filesystem::current_path(before_, ignored);
    }
    WorkingFolder(const WorkingFolder&) = delete;
    WorkingFolder& operator=(const WorkingFolder&) = delete;

    [[nodiscard]] bool is_empty() const { return std::filesystem::is_empty(folder_.path()); }

 private:
    ScratchFolder folder_;
    std::filesystem::path before_;
};

}  // namespace downwash::test
