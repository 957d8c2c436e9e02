#include "downwash/results/json_place.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace downwash::problems {
namespace {

/// The first byte behind the string that begins at `quote`.
std::size_t end_of_string(std::string_view text, std::size_t quote) {
    std::size_t at = quote + 1;
    while (at < text.size() && text[at] != '"') {
        at += text[at] == '\\' ? 2 : 1;
    }
    return std::min(at + 1, text.size());
}

/// Walks through the values of a JSON text and knows the key path of each.
class Walk {
 public:
    explicit Walk(std::string_view text) : text_(text) {}

    /// Where the value of that path begins; where the walk ended when there is none.
    std::size_t find(std::string_view key_path) {
        while (next_value()) {
            if (path() == key_path) {
                break;
            }
            enter_or_skip();
        }
        return at_;
    }

 private:
    struct Level {
        bool is_list;
        std::size_t index = 0;
        std::string key{};
    };

    /// Moves to where the next value begins; false at the end of the document, behind which a text may go on: the
    /// parser takes a byte of zero for the end.
    bool next_value() {
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == ']' || c == '}') {
                levels_.pop_back();
                if (levels_.empty()) {
                    return false;
                }
            } else if (c == ',') {
                ++levels_.back().index;
                expects_key_ = !levels_.back().is_list;
            } else if (c == '"' && expects_key_) {
                const std::size_t end = end_of_string(text_, at_);
                levels_.back().key = text_.substr(at_ + 1, end - at_ - 2);
                expects_key_ = false;
                at_ = end - 1;
            } else if (std::string_view(" \t\r\n:").find(c) == std::string_view::npos) {
                return true;
            }
        }
        return false;
    }

    void enter_or_skip() {
        const char c = text_[at_];
        if (c == '{' || c == '[') {
            levels_.push_back({c == '['});
            expects_key_ = c == '{';
            ++at_;
        } else if (c == '"') {
            at_ = end_of_string(text_, at_);
        } else {
            at_ = std::min(text_.find_first_of(",]} \t\r\n", at_), text_.size());
        }
    }

    [[nodiscard]] std::string path() const {
        std::string path;
        for (const Level& level : levels_) {
            if (level.is_list) {
                path += "[" + std::to_string(level.index) + "]";
            } else {
                path += (path.empty() ? "" : ".") + level.key;
            }
        }
        return path;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    bool expects_key_ = false;
    std::vector<Level> levels_;
};

}  // namespace

TextPlace place_of_byte(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte);
    const auto lines = std::count(before.begin(), before.end(), '\n');
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
    return {static_cast<int>(lines) + 1, static_cast<int>(before.size() - line_begin) + 1};
}

TextPlace json_place(std::string_view text, std::string_view key_path) {
    return place_of_byte(text, Walk(text).find(key_path));
}

}  // namespace downwash::problems
