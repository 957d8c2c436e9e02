#include "program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

namespace downwash::test {
namespace {

namespace fs = std::filesystem;

void redirect(const fs::path& file, int descriptor) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (opened < 0 || dup2(opened, descriptor) < 0) {
        _exit(127);
    }
}

[[noreturn]] void become_program(const fs::path& folder, const fs::path& in, const fs::path& out, const fs::path& err,
                                 const Words& arguments, const Environment& environment) {
    for (const auto& [name, value] : environment) {
        value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
    }
    std::vector<char*> argv{const_cast<char*>(DOWNWASH_PROGRAM)};  // NOLINT(cppcoreguidelines-pro-type-const-cast): C
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));  // NOLINT(cppcoreguidelines-pro-type-const-cast): C
    }
    argv.push_back(nullptr);
    const int input = open(in.c_str(), O_RDONLY);
    if (input < 0 || dup2(input, STDIN_FILENO) < 0) {
        _exit(127);
    }
    redirect(out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    if (chdir(folder.c_str()) == 0) {
        execv(argv[0], argv.data());
    }
    _exit(127);
}

}  // namespace

void words_of::add(Words& all, const char* blank_separated) {
    std::istringstream text(blank_separated);
    all.insert(all.end(), std::istream_iterator<std::string>(text), {});
}

std::string shipped_file(const std::string& name) {
    return std::string(DOWNWASH_PROBLEMS) + "/" + name + ".yaml";
}

std::string problem_file(const std::string& name) {
    static const ScratchFolder folder;
    const fs::path file = folder / (name + ".yaml");
    write_file(file, problem_text(name));
    return file.string();
}

std::string problem_text(const std::string& name) {
    const std::string of_ideal_robot = replaced(read_file(shipped_file(name)), "robots/ars_lrm",
                                                std::string(DOWNWASH_PROBLEMS) + "/robots/ars_lrm_ideal");
    return replaced(of_ideal_robot, "uncertainty: {}", "uncertainty: none");
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
    const std::size_t at = text.find(part);
    REQUIRE(at != std::string::npos);
    return text.replace(at, part.size(), by);
}

std::string read_file(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

Result succeeded(Result result) {
    CAPTURE(result.err);
    REQUIRE(result.code == 0);
    return result;
}

void check_rejected(const Result& result, const std::string& reason) {
    CHECK(result.code == 2);
    CHECK(result.out.empty());
    CHECK_THAT(result.err, Catch::Contains(reason));
}

std::map<std::string, std::string> Workspace::files(const std::string& below) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(in_run(below))) {
        if (entry.is_regular_file()) {
            files[fs::relative(entry.path(), in_run(below)).string()] = read_file(entry.path());
        }
    }
    return files;
}

Result Workspace::run_in(const Environment& environment, const std::string& input, const Words& arguments) const {
    return Program(*this, arguments, environment, input).wait();
}

Program::Program(const Workspace& work, const Words& arguments, const Environment& environment,
                 const std::string& input)
    : out_(work / "standard-output"), err_(work / "standard-error") {
    const fs::path in = work / "standard-input";
    write_file(in, input);
    process_ = fork();
    if (process_ == 0) {
        Environment whole = environment;
        whole.emplace("XDG_CACHE_HOME", work / "cache");
        become_program(work.in_run(), in, out_, err_, arguments, whole);
    }
}

void Program::send(int signal) const {
    kill(process_, signal);
}

bool Program::has_said(const std::string& text) const {
    for (int i = 0; i < 2000; ++i) {
        if (read_file(err_).find(text) != std::string::npos) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

Result Program::wait() const {
    int status = 0;
    waitpid(process_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(out_), read_file(err_)};
}

}  // namespace downwash::test
