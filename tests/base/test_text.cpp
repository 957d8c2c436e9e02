#include "downwash/base/text.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <string_view>

#include "../support/base64_bytes.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/sha256.hpp"

using namespace downwash;

TEST_CASE("numbers are written shortly and read back the same") {
    CHECK(to_text(0.1) == "0.1");
    CHECK(to_text(100000.0) == "100000");
    CHECK(to_text(-0.0) == "-0");
    CHECK(to_text(1e-300) == "1e-300");
    CHECK(std::stod(to_text(0.1 + 0.2)) == 0.1 + 0.2);
    CHECK(to_text(48.5429175, 4) == "48.54");
}

TEST_CASE("text is UTF-8 if each of its characters is") {
    CHECK(is_utf8(""));
    CHECK(is_utf8("caf\xc3\xa9 \xe2\x82\xac"));
    CHECK_FALSE(is_utf8("caf\xe9"));   // Latin-1
    CHECK_FALSE(is_utf8("\xc3"));      // cut within a character
    CHECK_FALSE(is_utf8("\xc0\xaf"));  // overlong
}

TEST_CASE("a number with so many decimals has no minus sign before zero") {
    CHECK(to_fixed_text(1.0625, 3) == "1.062");  // halves go to the even digit
    CHECK(to_fixed_text(-0.0004, 3) == "0.000");
    CHECK(to_fixed_text(-0.0, 0) == "0");
    CHECK(to_fixed_text(-0.0006, 3) == "-0.001");
    CHECK(to_fixed_text(-10, 1) == "-10.0");
    CHECK(to_fixed_text(1e300, 0).size() == 301);
}

TEST_CASE("a misspelt word is taken for the nearest name, a strange one for none") {
    const std::array<std::string_view, 3> names{"energy", "time", "clearance"};
    CHECK(nearest_name("enrgy", names) == "energy");
    CHECK(nearest_name("tiem", names) == "time");
    CHECK(nearest_name("comfort", names).empty());
    CHECK(nearest_name(std::string(100000, 'x'), names).empty());
    CHECK(joined_names(names) == "energy, time or clearance");
}

TEST_CASE("a long text is cut between characters") {
    CHECK(excerpt("short\ntext") == "short text");
    CHECK(excerpt(std::string(47, 'a') + "\xc3\xa4" + "bc") == std::string(47, 'a') + "...");
    CHECK(excerpt(std::string(46, 'a') + "\xe2\x82\xac" + "bc") ==
          std::string(46, 'a') + "...");  // after two of three bytes
    CHECK(excerpt(std::string(48, 'a')) == std::string(48, 'a'));
    CHECK(excerpt(std::string(48, 'a') + "b") == std::string(48, 'a') + "...");
}

TEST_CASE("an excerpt is text, whatever bytes it is of") {
    CHECK(excerpt("\xff\xfe#") == "\\xff\\xfe#");
    CHECK(excerpt("Br\xfc"
                  "cke") == "Br\\xfccke");
    CHECK(excerpt("Br\xc3\xbc"
                  "cke") ==
          "Br\xc3\xbc"
          "cke");
    // Escape, delete and the control sequence introducer of eight bits speak to terminals.
    CHECK(excerpt("a\x1b[31mb\x7f"
                  "c\xc2\x9b"
                  "2Jd") == "a [31mb c 2Jd");
    for (int first = 0; first < 256; ++first) {
        for (int second = 0; second < 256; ++second) {
            const std::string shown = excerpt(std::string{static_cast<char>(first), static_cast<char>(second)});
            REQUIRE(is_utf8(shown));
        }
    }
}

TEST_CASE("names of keys carry their units") {
    CHECK(unit_of("multirotor.pitch_inertia_kg_m2") == "kg m2");
    CHECK(unit_of("start.pitch_rate_deg_s") == "deg/s");
    CHECK(unit_of("planner.seed").empty());
    CHECK(is_in_degrees("goal.configuration.tolerance_deg"));
    CHECK(without_unit("mass_kg") == "mass");
    CHECK(is_stem_with_unit("mass_g", "mass"));
    CHECK_FALSE(is_stem_with_unit("mass_centre", "mass"));
}

TEST_CASE("SHA-256 gives the digests of its standard") {
    CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("base64 is that of RFC 4648 and nothing else") {
    const std::array<std::array<std::string_view, 2>, 8> pairs{{{"", ""},
                                                                {"f", "Zg=="},
                                                                {"fo", "Zm8="},
                                                                {"foo", "Zm9v"},
                                                                {"foob", "Zm9vYg=="},
                                                                {"fooba", "Zm9vYmE="},
                                                                {"foobar", "Zm9vYmFy"},
                                                                {"\xfb\xff\xfe", "+//+"}}};
    for (const auto& [bytes, text] : pairs) {
        CHECK(base64_text(bytes) == text);
        CHECK(test::base64_bytes(text) == bytes);
        CHECK(text.size() == base64_letters(bytes.size()));
    }
    for (const char* text :
         {"Zg=", "Zg", "Z===", "====", "Zg=v", "Zh==", " Zg==", "Zg==\n\n\n\n", "Zg-=", "Z\xc3\xa4v"}) {
        CAPTURE(text);
        CHECK_FALSE(test::base64_bytes(text));
    }
}

TEST_CASE("words are taken from the front of a text") {
    std::string_view rest = "\t one  two\r\n";
    CHECK(take_word(rest) == "one");
    CHECK(take_word(rest) == "two");
    CHECK(take_word(rest).empty());
    CHECK(trimmed(" \n ").empty());
    CHECK(trimmed("\va b\f") == "a b");
}
