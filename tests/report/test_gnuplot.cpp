#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>

#include "../support/scratch_folder.hpp"
#include "downwash/report/gnuplot.hpp"
#include "downwash/report/picture.hpp"
#include "downwash/report/picture_text.hpp"
#include "pictures.hpp"

using namespace downwash;
using Catch::Matchers::Contains;
using downwash::test::ScratchFolder;

namespace {

/// Another value of an environment variable, as long as this lives.
class Environment {
 public:
    Environment(const char* name, const char* value) : name_(name), before_(std::getenv(name)) {
        setenv(name, value, 1);
    }
    ~Environment() { setenv(name_, before_.c_str(), 1); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

 private:
    const char* name_;
    std::string before_;
};

}  // namespace

TEST_CASE("gnuplot answers on its standard output without the settings of the user, or its package is named") {
    const ScratchFolder home;
    std::ofstream(home / ".gnuplot") << "print 'settings of the user'\nset print '-'\nprint 'again'\n";
    const Environment user("HOME", home.path().c_str());
    CHECK(run_gnuplot("set print '-'\nprint 6 * 7\n") == "42\n");
    const ScratchFolder empty;
    const Environment path("PATH", empty.path().c_str());
    CHECK_THROWS_WITH(run_gnuplot("print 1"), Contains("gnuplot-nox") && Contains("PATH does not contain it"));
    CHECK_THROWS_AS(run_gnuplot("print 1"), PictureError);
}

TEST_CASE("a script that fails, and one that draws nothing, are told with gnuplot's own words") {
    CHECK_THROWS_WITH(run_gnuplot("set print '-'\nprint 1\nset nonsense\n"), Contains("gnuplot failed"));
    CHECK_THROWS_WITH(run_gnuplot("unset key\n"), Contains("gnuplot failed"));
    // One that does not end is ended.
    CHECK_THROWS_WITH(run_gnuplot("while (1) { x = 1 }\n", std::chrono::milliseconds(300)), Contains("took longer"));
}

TEST_CASE("text of others is shown by gnuplot, never run") {
    const test::WorkingFolder folder;
    for (const std::string& text : test::hostile_texts()) {
        const std::string answer = run_gnuplot("set encoding utf8\nset print '-'\nprint " + in_quotes(text) + "\n");
        CHECK(answer == picture_text(text) + "\n");
    }
    CHECK(folder.is_empty());
}

TEST_CASE("shown text is one line of valid UTF-8, cut between characters") {
    CHECK(picture_text("a\tb\nc") == "a b c");
    CHECK(picture_text("naïve 桥 🚁") == "naïve 桥 🚁");
    CHECK(picture_text("\xc3(") == "?(");
    CHECK(picture_text("\xc0\xaf") == "??");            // an overlong slash
    CHECK(picture_text("\xed\xa0\x80") == "???");       // a surrogate
    CHECK(picture_text("\xf4\x90\x80\x80") == "????");  // beyond U+10FFFF
    CHECK(picture_text("\xe2\x82") == "??");            // an end too soon
    CHECK(picture_text("\xef\xbf\xbf") == "?");         // not a character of XML
    CHECK(picture_text("\xc2\x85|\x7f") == " | ");      // controls
    CHECK(picture_text("ééééé", 3) == "ééé…");
    CHECK(picture_text("ééé", 3) == "ééé");
    CHECK(in_quotes("it's") == "'it’s'");
}

TEST_CASE("the extension of a file decides what a picture is stored as") {
    CHECK(picture_format_of("a/b.svg") == PictureFormat::svg);
    CHECK(picture_format_of("b.PNG") == PictureFormat::png);
    CHECK_FALSE(picture_format_of("svg"));
    CHECK(picture_format_of("a.svg/b.pdf") == PictureFormat::pdf);
    CHECK_FALSE(picture_format_of("a.svg/b.bmp"));
    CHECK_FALSE(picture_format_of(""));
}
