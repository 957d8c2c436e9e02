#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"

namespace {

/// A folder in which a problem finds the files that the shipped problems refer to.
class ProblemFolder {
 public:
    ProblemFolder() {
        for (const char* name : {"robots", "meshes", "maps"}) {
            std::filesystem::create_directory_symlink(std::filesystem::path(DOWNWASH_PROBLEMS) / name, folder_ / name);
        }
    }
    [[nodiscard]] std::filesystem::path file() const { return folder_ / "problem.yaml"; }

 private:
    downwash::test::ScratchFolder folder_;
};

}  // namespace

/// Whatever is read as a sound problem can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const ProblemFolder folder;
    downwash::write_file(folder.file(), {reinterpret_cast<const char*>(data), size});
    std::string written;
    try {
        written = downwash::effective_yaml(downwash::read_problem(folder.file()), folder.file().parent_path());
    } catch (const downwash::ProblemFileError&) {
        return 0;
    }
    downwash::write_file(folder.file(), written);
    static_cast<void>(downwash::read_problem(folder.file()));
    return 0;
}
