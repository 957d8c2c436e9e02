#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <thread>
#include <vector>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"

using namespace downwash;
using downwash::test::ScratchFolder;

namespace {

auto files_in(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

}  // namespace

TEST_CASE("a file reads back as it was written, whatever its bytes, and no further than asked") {
    const ScratchFolder folder;
    const std::string bytes("a\0b\r\n\xff", 6);
    write_file(folder / "file", bytes);
    CHECK(read_file(folder / "file", 100) == bytes);
    CHECK(read_file(folder / "file", 6) == bytes);
    CHECK(read_file(folder / "file", 3) == bytes.substr(0, 3));
    CHECK(read_whole_file(folder / "file", 6) == bytes);
    CHECK_THROWS_WITH(read_whole_file(folder / "file", 5), "is larger than 0 MiB: expected a smaller file");
    CHECK_THROWS_WITH(read_whole_file(folder / "missing", 5), "cannot be read: there is no such file");
    write_file(folder / "file", "");
    CHECK(read_file(folder / "file", 100).empty());
}

TEST_CASE("what is no file is told by what it is") {
    const ScratchFolder folder;
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK_THROWS_WITH(read_file(folder / "missing", 10), "cannot be read: there is no such file");
    CHECK_THROWS_WITH(read_file(folder.path(), 10), "cannot be read: it is a directory, expected a file");
    CHECK_THROWS_WITH(read_file(folder / "pipe", 10), "cannot be read: expected an ordinary file");
}

TEST_CASE("a file that cannot be written leaves nothing behind") {
    const ScratchFolder folder;
    CHECK_THROWS_WITH(write_file(folder / "missing/file", "text"), "cannot be written: No such file or directory");
    std::filesystem::create_directories(folder / "place/full");
    CHECK_THROWS_AS(write_file(folder / "place", "text"), FileError);
    CHECK(files_in(folder.path()) == 1);
    CHECK_NOTHROW(require_writable(folder / "file"));
    CHECK_THROWS_AS(require_writable(folder / "missing/file"), FileError);
    CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("threads that write the same file at once leave one of their texts whole") {
    const ScratchFolder folder;
    std::vector<std::jthread> writers;
    for (char letter = 'a'; letter < 'e'; ++letter) {
        writers.emplace_back([&folder, letter] {
            for (int i = 0; i < 50; ++i) {
                write_file(folder / "file", std::string(10000, letter));
            }
        });
    }
    writers.clear();
    const std::string text = read_file(folder / "file", 20000);
    REQUIRE(text.size() == 10000);
    CHECK(text == std::string(10000, text[0]));
    CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a file written onto a symbolic link goes where the link leads, and the link stays") {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder / "store");
    write_file(folder / "store/file", "old");
    std::filesystem::create_symlink("store/file", folder / "link");
    std::filesystem::create_symlink(folder / "link", folder / "second");
    std::filesystem::create_symlink("store/new", folder / "dangling");
    write_file(folder / "second", "new");
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(std::filesystem::is_symlink(folder / "second"));
    CHECK(read_file(folder / "store/file", 10) == "new");
    write_file(folder / "dangling", "more");
    CHECK(read_file(folder / "store/new", 10) == "more");
    CHECK(files_in(folder / "store") == 2);
    std::filesystem::create_symlink("round", folder / "round");
    CHECK_THROWS_AS(write_file(folder / "round", "text"), FileError);
    CHECK_THROWS_AS(require_writable(folder / "round"), FileError);
}
