#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"

namespace {

/// A folder in which a problem finds the files that the shipped problems refer to, from `problems` and from a folder in
/// it.
class ProblemFolder {
 public:
    ProblemFolder() {
        std::filesystem::create_directory(file().parent_path());
        for (const char* name : {"robots", "meshes", "maps"}) {
            const std::filesystem::path shipped = std::filesystem::path(DOWNWASH_PROBLEMS) / name;
            std::filesystem::create_directory_symlink(shipped, folder_ / name);
            std::filesystem::create_directory_symlink(shipped, file().parent_path() / name);
        }
    }
    [[nodiscard]] std::filesystem::path file() const { return folder_ / "space" / "problem.yaml"; }

 private:
    downwash::test::ScratchFolder folder_;
};

std::string read(const std::filesystem::path& file) {
    return downwash::is_space_problem_file(file)
               ? downwash::effective_yaml(downwash::read_space_problem(file), file.parent_path())
               : downwash::effective_yaml(downwash::read_problem(file), file.parent_path());
}

}  // namespace

/// Whatever is read as a sound problem can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const ProblemFolder folder;
    downwash::write_file(folder.file(), {reinterpret_cast<const char*>(data), size});
    std::string written;
    try {
        written = read(folder.file());
    } catch (const downwash::ProblemFileError&) {
        return 0;
    }
    downwash::write_file(folder.file(), written);
    static_cast<void>(read(folder.file()));
    return 0;
}
