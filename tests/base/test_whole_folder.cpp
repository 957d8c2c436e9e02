#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <map>
#include <thread>
#include <vector>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/whole_folder.hpp"

using namespace downwash;
using downwash::test::ScratchFolder;

namespace {

namespace fs = std::filesystem;
using Content = std::map<std::string, std::string>;

const std::vector<std::string> names{"plan", "scene", "page"};

/// The files of a run; only the second one has a page.
WholeFolder::Files files_of(const std::string& run) {
    WholeFolder::Files files{{"scene", run}, {"plan", run}};
    if (run == "second") {
        files.insert(files.begin(), {"page", run});
    }
    return files;
}

const Content first{{"plan", "first"}, {"scene", "first"}};
const Content second{{"plan", "second"}, {"scene", "second"}, {"page", "second"}};

void write_run(const fs::path& place, const std::string& run) {
    WholeFolder(place, names).write(files_of(run));
}

/// Every entry of a folder with its content; a folder as "/".
Content content_of(const fs::path& folder) {
    Content content;
    for (const auto& entry : fs::directory_iterator(folder)) {
        content[entry.path().filename()] = entry.is_directory() ? "/" : read_file(entry.path(), 100);
    }
    return content;
}

Content with(Content content, const Content& more) {
    content.insert(more.begin(), more.end());
    return content;
}

bool is_hidden(const std::string& name) {
    return name[0] == '.';
}

/// Where system calls that wait for the disk take no time.
fs::path in_memory() {
    return fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
}

/// From now on, this process gets an error from a system call.
void forbid(long call, unsigned error) {
    const auto number = static_cast<unsigned>(call);
    std::array filter{sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1),
                      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | error),
                      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
    const sock_fprog program{filter.size(), filter.data()};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
        _exit(2);
    }
}

enum class System { all_calls, no_exchange, no_links };

/// Where a run is written.
struct Setting {
    System system = System::all_calls;
    bool is_current = false;  ///< whether the process stands in the folder
};

/// Writes the second run in a process of its own and kills that at the so-manyth beginning or end of a system call.
/// @return whether it came to its end before
bool write_and_kill(const fs::path& place, const Setting& in, int stop) {
    const pid_t process = fork();
    if (process == 0) {
        if (in.is_current && chdir(place.c_str()) != 0) {
            _exit(2);
        }
        if (in.system == System::no_exchange) {
            forbid(SYS_renameat2, EINVAL);
        } else if (in.system == System::no_links) {
            forbid(SYS_linkat, EPERM);
        }
        if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0 || raise(SIGSTOP) != 0) {
            _exit(2);
        }
        try {
            write_run(place, "second");
        } catch (const std::exception&) {
            _exit(1);
        }
        _exit(0);
    }
    int status = 0;
    waitpid(process, &status, 0);
    for (int i = 0; WIFSTOPPED(status); ++i) {
        i < stop ? ptrace(PTRACE_SYSCALL, process, nullptr, nullptr) : kill(process, SIGKILL);
        waitpid(process, &status, 0);
    }
    REQUIRE((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
    return WIFEXITED(status);
}

/// Kills a writer at each of its system calls and looks at what it leaves each time.
template <class Check>
void kill_everywhere(const fs::path& folder, const Setting& in, const Content& before, const Check& check) {
    bool is_over = false;
    for (int stop = 1; !is_over; ++stop) {
        REQUIRE(stop < 2000);
        fs::remove_all(folder);
        fs::create_directories(folder / "run");
        for (const auto& [name, text] : before) {
            text == "/" ? static_cast<void>(fs::create_directory(folder / "run" / name))
                        : write_file(folder / "run" / name, text);
        }
        is_over = write_and_kill(folder / "run", in, stop);
        CAPTURE(stop, is_over);
        check(is_over);
        // The next writer cleans up.
        write_run(folder / "run", "first");
        REQUIRE(content_of(folder).size() == 1);
        Content expected = with(first, before);
        expected["plan"] = expected["scene"] = "first";
        REQUIRE(content_of(folder / "run") == expected);
    }
}

}  // namespace

TEST_CASE("a folder appears in its place with all its files, and replaces what such a folder held before") {
    const ScratchFolder folder;
    const fs::path place = folder / "above/run";
    {
        WholeFolder run(place, names);
        CHECK_FALSE(fs::exists(place));
        run.write(files_of("second"));
    }
    CHECK(content_of(place) == second);
    write_run(place, "first");
    CHECK(content_of(place) == first);
    CHECK(content_of(folder / "above").size() == 1);
}

TEST_CASE("files of others in a folder stay, whatever is in it") {
    const ScratchFolder folder;
    const fs::path place = folder / "run";
    write_run(place, "second");
    write_file(place / "notes.txt", "mine");
    Content others{{"notes.txt", "mine"}, {"link", "mine"}};
    fs::create_symlink("notes.txt", place / "link");
    if (GENERATE(false, true)) {
        fs::create_directory(place / "below");
        write_file(place / "below/more.txt", "more");
        others["below"] = "/";
    }
    write_run(place, "first");
    CHECK(content_of(place) == with(first, others));
    CHECK(fs::is_symlink(place / "link"));
    CHECK((!others.contains("below") || read_file(place / "below/more.txt", 10) == "more"));
    CHECK(content_of(folder.path()).size() == 1);
}

TEST_CASE("a folder keeps its permissions, and one that is reached through a link stays where it is") {
    const ScratchFolder folder;
    write_run(folder / "store", "first");
    fs::permissions(folder / "store", fs::perms(0750));
    fs::create_directory_symlink("store", folder / "link");
    write_run(folder / "link/", "second");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(content_of(folder / "store") == second);
    CHECK(fs::status(folder / "store").permissions() == fs::perms(0750));
}

TEST_CASE("a kill at any moment leaves the old folder or the new one, and the next writer cleans up") {
    const ScratchFolder folder(in_memory());
    const Content notes = GENERATE(Content{}, Content{{"notes.txt", "mine"}});
    const fs::path run = folder / "at/run";
    bool was_new = false;
    kill_everywhere(folder / "at", {}, with(first, notes), [&](bool is_over) {
        const Content found = content_of(run);
        REQUIRE((found == with(first, notes) || found == with(second, notes)));
        REQUIRE((!is_over || found == with(second, notes)));
        was_new = was_new || (!is_over && found == with(second, notes));
    });
    CHECK(was_new);  // kills after the change were among them
}

TEST_CASE(
    "where folders cannot change places, a kill leaves one of them, or an empty place and the old one is put back") {
    const ScratchFolder folder(in_memory());
    bool was_missing = false;
    kill_everywhere(folder / "at", {System::no_exchange}, first, [&](bool is_over) {
        if (!fs::exists(folder / "at/run")) {
            was_missing = true;
            const WholeFolder next(folder / "at/run", names);  // before it writes anything
            REQUIRE(content_of(folder / "at/run") == first);
        } else {
            const Content found = content_of(folder / "at/run");
            REQUIRE((found == second || (!is_over && found == first)));
        }
    });
    CHECK(was_missing);
}

TEST_CASE("where a folder cannot be moved, a kill leaves the old files, the new ones, or no whole folder") {
    const ScratchFolder folder(in_memory());
    const auto [setting, others] =
        GENERATE(std::pair(Setting{System::all_calls, true}, Content{}), std::pair(Setting{}, Content{{"below", "/"}}),
                 std::pair(Setting{System::no_links}, Content{{"notes.txt", "mine"}}));
    kill_everywhere(folder / "at", setting, with(first, others), [&, kept = others](bool is_over) {
        Content found = content_of(folder / "at/run");
        for (const auto& [name, text] : kept) {
            REQUIRE(found.at(name) == text);
            found.erase(name);
        }
        std::erase_if(found, [](const auto& entry) { return is_hidden(entry.first); });
        REQUIRE((found == second || (!is_over && (found == first || !found.contains("plan")))));
    });
}

TEST_CASE("a folder that somebody else is going to write is refused, by the name of the process") {
    const ScratchFolder folder;
    const fs::path place = folder / "run";
    const std::string process = "process " + std::to_string(getpid()) + " is about to write";
    {
        const WholeFolder running(place, names);
        CHECK_THROWS_WITH(WholeFolder(place, names), Catch::Contains(place.string()) && Catch::Contains(process));
        CHECK_NOTHROW(WholeFolder(folder / "ru", names));
    }
    CHECK(content_of(folder.path()).empty());
    write_run(place, "first");
    fs::create_directory(place / "below");  // a folder to be written in place is claimed, too
    const WholeFolder running(place, names);
    CHECK_THROWS_WITH(WholeFolder(place, names), Catch::Contains(process));
}

TEST_CASE("threads that write the same folder at once leave one of their runs whole") {
    const ScratchFolder folder;
    std::vector<std::jthread> writers;
    for (const char* run : {"first", "second", "first", "second"}) {
        writers.emplace_back([&folder, run] {
            for (int i = 0; i < 20; ++i) {
                try {
                    write_run(folder / "run", run);
                } catch (const FolderError&) {  // not our turn
                }
            }
        });
    }
    writers.clear();
    const Content found = content_of(folder / "run");
    CHECK((found == first || found == second));
    CHECK(content_of(folder.path()).size() == 1);
}

TEST_CASE("a folder that cannot be written is refused at once, and nothing is left behind") {
    const ScratchFolder folder;
    const auto reason = [](const fs::path& place) { return place.string() + " cannot be written: "; };
    write_file(folder / "file", "text");
    fs::create_symlink("nowhere", folder / "dangling");
    fs::create_directories(folder / "odd/plan");
    CHECK_THROWS_WITH(WholeFolder(folder / "file", names), reason(folder / "file") + "it is a file, expected a folder");
    CHECK_THROWS_WITH(WholeFolder(folder / "file/below", names), Catch::StartsWith(reason(folder / "file/below")));
    CHECK_THROWS_WITH(WholeFolder(folder / "dangling", names), Catch::StartsWith(reason(folder / "dangling")));
    CHECK_THROWS_WITH(WholeFolder(folder / "odd", names),
                      reason(folder / "odd/plan") + "it is a folder, expected a file");
    if (geteuid() != 0) {  // nothing is forbidden to root
        write_run(folder / "locked/run", "first");
        fs::permissions(folder / "locked/run", fs::perms(0500));
        CHECK_THROWS_WITH(WholeFolder(folder / "locked/run", names), Catch::EndsWith("Permission denied"));
        fs::permissions(folder / "locked/run", fs::perms(0700));
        fs::permissions(folder / "locked", fs::perms(0500));
        CHECK_THROWS_WITH(WholeFolder(folder / "locked/new", names), Catch::EndsWith("Permission denied"));
        write_run(folder / "locked/run", "second");  // nothing new can be beside it, but in it
        CHECK(content_of(folder / "locked/run") == second);
        fs::permissions(folder / "locked", fs::perms(0700));
    }
    CHECK(std::none_of(fs::directory_iterator(folder.path()), fs::directory_iterator(),
                       [](const auto& entry) { return is_hidden(entry.path().filename()); }));
}
