#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"

/// Whatever is read as a sound robot in space can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const downwash::test::ScratchFolder folder;
    const std::filesystem::path file = folder / "robot.yaml";
    downwash::write_file(file, {reinterpret_cast<const char*>(data), size});
    std::string written;
    try {
        if (!downwash::is_space_robot_file(file)) {
            static_cast<void>(downwash::read_robot(file));
            return 0;
        }
        written = downwash::robot_yaml(downwash::read_space_robot(file, [](const downwash::LocatedError&) {}));
    } catch (const downwash::ProblemFileError&) {
        return 0;
    }
    downwash::write_file(file, written);
    static_cast<void>(downwash::read_space_robot(file));
    return 0;
}
