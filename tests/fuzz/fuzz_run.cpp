#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/exports/export_format.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/results/run_record.hpp"

namespace {

using namespace downwash;

constexpr std::array files{"trajectory.csv", "tree.csv", "solution.json"};
constexpr std::string_view separator = "====\n";

class RunFolder {
 public:
    RunFolder() {
        write_file(folder_ / "effective.yaml",
                   effective_yaml(read_problem(DOWNWASH_PROBLEMS "/open_air.yaml"), folder_.path()));
    }

    /// Every file in turn, each up to a separator.
    void fill(std::string_view bytes) const {
        for (const char* file : files) {
            const std::size_t end = bytes.find(separator);
            write_file(folder_ / file, bytes.substr(0, end));
            bytes = end == std::string_view::npos ? "" : bytes.substr(end + separator.size());
        }
    }

    [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

 private:
    test::ScratchFolder folder_;
};

/// What reads well can be written for other programs; set-points aside, of which there may be a million.
void export_run(const RunRecord& run) {
    ExportSettings settings;
    settings.origin = GeodeticOrigin{47, 8, 100};
    settings.bearing_deg = 30;
    for (const ExportFormat& format : export_formats) {
        try {
            if (!format.has_rate) {
                static_cast<void>(exported(run, format, settings));
            }
        } catch (const InputError&) {
        }
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const RunFolder folder;
    folder.fill({reinterpret_cast<const char*>(data), size});
    try {
        export_run(read_run(folder.path()));
    } catch (const ProblemFileError&) {
    } catch (const InputError&) {
    }
    return 0;
}
