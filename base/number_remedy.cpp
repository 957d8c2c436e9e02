#include "downwash/base/number_remedy.hpp"

#include <array>
#include <cstddef>

#include "downwash/base/csv_dialect.hpp"

namespace downwash {
namespace {

struct Writing {
    std::string_view found;    ///< characters that no number has
    std::string_view instead;  ///< what numbers have there
    std::string_view remedy;
};

constexpr std::array writings{
    Writing{"\xE2\x88\x92", "-", "write its minus sign as '-', not as U+2212"},
    Writing{"\xE2\x80\x93", "-", "write its minus sign as '-', not as U+2013"},
    Writing{"\xC2\xA0", "", "leave out its no-break space U+00A0"},
    Writing{"\xE2\x80\xAF", "", "leave out its narrow no-break space U+202F"},
    Writing{"\xE2\x80\x89", "", "leave out its thin space U+2009"},
    Writing{"\xE2\x80\x99", "", "leave out its apostrophe U+2019"},
    Writing{"'", "", "leave out its apostrophes"},
    Writing{"%", "", "divide percent by 100 and leave out the sign"},
    Writing{"D", "e", "write its exponent with 'e', not 'D'"},
    Writing{"d", "e", "write its exponent with 'e', not 'd'"},
    Writing{",", ".", "write a decimal point, no comma"},
};

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
    std::string all(text);
    for (std::size_t at = all.find(from); at != std::string::npos; at = all.find(from, at + to.size())) {
        all.replace(at, from.size(), to);
    }
    return all;
}

}  // namespace

std::string number_remedy(std::string_view text, char decimal_sign) {
    for (const Writing& writing : writings) {
        if (text.find(writing.found) != std::string_view::npos &&
            decimal_number(replaced(text, writing.found, writing.instead), decimal_sign)) {
            return "; " + std::string(writing.remedy);
        }
    }
    return {};
}

}  // namespace downwash
