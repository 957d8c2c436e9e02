#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/problems/campaign_reader.hpp"
#include "downwash/problems/problem_reader.hpp"

/// Whatever stands in a campaign file, its runs can be counted.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const downwash::test::ScratchFolder folder;
    const std::filesystem::path file = folder / "campaign.yaml";
    downwash::write_file(file, {reinterpret_cast<const char*>(data), size});
    try {
        const downwash::ReadCampaign read = downwash::read_campaign(file);
        if (read.campaign.seeds.all().size() > downwash::max_campaign_runs) {
            __builtin_trap();
        }
    } catch (const downwash::ProblemFileError&) {
        return 0;
    }
    return 0;
}
