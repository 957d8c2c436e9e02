#include "program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
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
                                 const std::vector<std::string>& arguments, const Environment& environment) {
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

ScratchFolder::ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "downwash-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
    fs::create_directory(path_ / "run");
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string problem_file(const std::string& name) {
    return std::string(DOWNWASH_PROBLEMS) + "/" + name + ".yaml";
}

std::string read_file(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
        }
    }
    return files;
}

Program::Program(const ScratchFolder& folder, const std::vector<std::string>& arguments, const Environment& environment,
                 const std::string& input)
    : out_(folder / "standard-output"), err_(folder / "standard-error") {
    const fs::path in = folder / "standard-input";
    write_file(in, input);
    process_ = fork();
    if (process_ == 0) {
        Environment whole = environment;
        whole.emplace("XDG_CACHE_HOME", folder / "cache");
        become_program(folder.path() / "run", in, out_, err_, arguments, whole);
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

Result run(const ScratchFolder& folder, const std::vector<std::string>& arguments, const Environment& environment,
           const std::string& input) {
    return Program(folder, arguments, environment, input).wait();
}

}  // namespace downwash::test
