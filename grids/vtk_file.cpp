#include "downwash/grids/vtk_file.hpp"

#include <algorithm>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/grids/grid_formats.hpp"

namespace downwash {
namespace {

/// Longer texts are rejected.
constexpr std::size_t max_text_bytes = std::size_t{1} << 20U;

/// The text of an array, which may follow elements that describe it.
std::string_view text_of(pugi::xml_node array) {
    return trimmed(array.text().get());
}

std::optional<std::size_t> offset_of(pugi::xml_node array) {
    const std::string_view word = array.attribute("offset").value();
    return parse_number<std::size_t>(word);
}

/// Where arrays begin in the appended data.
struct OffsetCollector : pugi::xml_tree_walker {
    std::set<std::size_t> offsets;
    bool for_each(pugi::xml_node& node) override {
        if (const auto offset = offset_of(node)) {
            offsets.insert(*offset);
        }
        return true;
    }
};

std::string letters_of(const std::vector<double>& codes) {
    std::string letters;
    for (const double code : codes) {
        if (!(code >= -128 && code <= 255)) {
            throw VtkDataError("holds " + to_text(code) + ": expected codes of letters, -128 to 255");
        }
        letters += static_cast<char>(static_cast<int>(code));
    }
    return letters;
}

}  // namespace

VtkFile::VtkFile(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {
    cut_out_data();
    const pugi::xml_parse_result result =
        document_.load_buffer_inplace(xml_.data(), xml_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (result.status != pugi::status_ok) {
        fail_at(result.offset, std::string("is no XML: ") + result.description());
    }
    root_ = document_.document_element();
    if (std::string_view(root_.name()) != "VTKFile") {
        fail(root_, "<" + excerpt(root_.name()) + ">: expected <VTKFile>");
    }
    read_encoding();
    OffsetCollector collector;
    root_.traverse(collector);
    offsets_ = std::move(collector.offsets);
}

void VtkFile::fail(pugi::xml_node node, const std::string& message) const {
    fail_at(node.offset_debug(), message);
}

void VtkFile::fail_whole(const std::string& message) const {
    throw_input_error(name_ + ": " + message);
}

std::string VtkFile::title(pugi::xml_node array) {
    return "array '" + excerpt(array.attribute("Name").value()) + "'";
}

VtkFile::Arrays VtkFile::arrays_in(pugi::xml_node parent) const {
    Arrays arrays;
    for (const pugi::xml_node array : parent.children()) {
        if (!arrays.emplace(array.attribute("Name").value(), array).second) {
            fail(array, title(array) + " occurs twice");
        }
    }
    return arrays;
}

/// Reads the data of an array, and says which array it is if that fails.
template <class Read>
auto VtkFile::located(pugi::xml_node array, const Read& read) const {
    try {
        return read();
    } catch (const VtkDataError& error) {
        fail(array, title(array) + " " + error.what());
    }
}

std::vector<double> VtkFile::numbers(pugi::xml_node array, std::size_t count) const {
    const VtkNumberType* type = find_vtk_number_type(array.attribute("type").value());
    if (type == nullptr) {
        fail(array, title(array) + " has the type '" + excerpt(array.attribute("type").value()) +
                        "': expected Float32, Float64 or an integer type such as UInt8");
    }
    if (std::string_view(array.attribute("NumberOfComponents").as_string("1")) != "1") {
        fail(array, title(array) + " has several components: expected one number a point");
    }
    if (!is_ascii(array)) {
        const std::size_t size = count * type->bytes;
        return vtk_numbers(bytes_of(array, size, size), *type, encoding_.is_big_endian);
    }
    return located(array, [&] { return vtk_ascii_numbers(text_of(array), count); });
}

std::vector<std::string> VtkFile::texts(pugi::xml_node array) const {
    std::string letters;
    if (is_ascii(array)) {
        std::size_t count = 0;
        for (std::string_view rest = text_of(array); !take_word(rest).empty(); ++count) {
        }
        letters = located(array, [&] { return letters_of(vtk_ascii_numbers(text_of(array), count)); });
    } else {
        letters = bytes_of(array, 0, max_text_bytes);
    }
    std::vector<std::string> texts;
    for (std::size_t begin = 0; begin < letters.size();) {
        const std::size_t end = std::min(letters.find('\0', begin), letters.size());
        texts.push_back(letters.substr(begin, end - begin));
        begin = end + 1;
    }
    return texts;
}

/// Raw data may hold any byte: only the XML around it goes to the parser.
void VtkFile::cut_out_data() {
    cut_begin_ = bytes_.size();
    const std::size_t tag = bytes_.find("<AppendedData");
    const std::size_t tag_end = tag == std::string_view::npos ? tag : bytes_.find('>', tag);
    if (tag_end == std::string_view::npos || bytes_[tag_end - 1] == '/') {
        xml_ = bytes_;
        return;
    }
    cut_begin_ = bytes_.find_first_not_of(" \t\r\n", tag_end + 1);
    const std::size_t end = bytes_.rfind("</AppendedData");
    if (cut_begin_ == std::string_view::npos || end == std::string_view::npos || end < cut_begin_) {
        fail_whole("byte " + std::to_string(bytes_.size()) +
                   ": the file ends within its appended data: expected "
                   "</AppendedData> and </VTKFile>");
    }
    if (bytes_[cut_begin_] != '_') {
        fail_whole("byte " + std::to_string(cut_begin_) + ": expected '_' before the appended data");
    }
    data_ = bytes_.substr(cut_begin_ + 1, end - cut_begin_ - 1);
    cut_size_ = end - cut_begin_;
    xml_ = std::string(bytes_.substr(0, cut_begin_)) + std::string(bytes_.substr(end));
}

void VtkFile::read_encoding() {
    if (std::string_view(root_.attribute("type").value()) != "ImageData") {
        fail(root_, "VTK data of the type '" + excerpt(root_.attribute("type").value()) +
                        "': expected ImageData, a regular grid");
    }
    encoding_.is_big_endian = one_of("byte_order", {"LittleEndian", "BigEndian"}, "LittleEndian") == 1;
    encoding_.header_bytes = one_of("header_type", {"UInt32", "UInt64"}, "UInt32") == 1 ? 8 : 4;
    const std::string_view compressor = root_.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
        fail(root_, "the data is compressed by '" + excerpt(compressor) + "': expected vtkZLibDataCompressor or none");
    }
    encoding_.is_compressed = !compressor.empty();
    const pugi::xml_node appended = root_.child("AppendedData");
    const std::string_view encoding = appended.attribute("encoding").as_string("base64");
    if (encoding != "raw" && encoding != "base64") {
        fail(appended, "appended data in '" + excerpt(encoding) + "': expected raw or base64");
    }
    is_base64_ = encoding == "base64";
}

/// Which of two values an attribute of the file's head has.
int VtkFile::one_of(const char* attribute, const std::array<std::string_view, 2>& values, const char* otherwise) const {
    const std::string_view value = root_.attribute(attribute).as_string(otherwise);
    const auto* found = std::find(values.begin(), values.end(), value);
    if (found == values.end()) {
        fail(root_, std::string(attribute) + " is '" + excerpt(value) + "': expected " + joined_names(values));
    }
    return static_cast<int>(found - values.begin());
}

bool VtkFile::is_ascii(pugi::xml_node array) const {
    const std::string_view format = array.attribute("format").as_string("ascii");
    if (format != "ascii" && format != "binary" && format != "appended") {
        fail(array, title(array) + " has the format '" + excerpt(format) + "': expected ascii, binary or appended");
    }
    return format == "ascii";
}

std::string VtkFile::bytes_of(pugi::xml_node array, std::size_t min_bytes, std::size_t max_bytes) const {
    if (std::string_view(array.attribute("format").value()) == "appended") {
        return appended_bytes(array, min_bytes, max_bytes);
    }
    return located(array, [&] { return vtk_bytes(text_of(array), true, encoding_, min_bytes, max_bytes); });
}

std::string VtkFile::appended_bytes(pugi::xml_node array, std::size_t min_bytes, std::size_t max_bytes) const {
    const auto given = offset_of(array);
    if (!given || *given > data_.size()) {
        fail(array, title(array) + " has the offset '" + excerpt(array.attribute("offset").value()) +
                        "': expected a place in the " + std::to_string(data_.size()) + " bytes of appended data");
    }
    const std::size_t offset = *given;
    const auto next = offsets_.upper_bound(offset);
    const std::size_t data_end = next == offsets_.end() ? data_.size() : std::min(*next, data_.size());
    try {
        return vtk_bytes(data_.substr(offset, data_end - offset), is_base64_, encoding_, min_bytes, max_bytes);
    } catch (const VtkDataError& error) {
        fail_whole("byte " + std::to_string(cut_begin_ + 1 + offset) + ": " + title(array) + " " + error.what());
    }
}

/// @param offset in the XML without the data
void VtkFile::fail_at(std::ptrdiff_t offset, const std::string& message) const {
    const std::size_t place = offset < 0 ? 0 : static_cast<std::size_t>(offset);
    if (place > cut_begin_) {
        fail_whole("byte " + std::to_string(place + cut_size_) + ": " + message);
    }
    const std::string_view before = bytes_.substr(0, place);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t column = place - (before.rfind('\n') + 1) + 1;  // without a line break before: npos + 1 = 0
    throw_input_error(name_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message);
}

}  // namespace downwash
