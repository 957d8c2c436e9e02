#pragma once

#include <string>
#include <string_view>

#include "downwash/bench/campaign_data.hpp"

namespace downwash::bench {

/// The commit that this program was built from, with "-dirty" where tracked files differed; "unknown" where there is no
/// repository.
[[nodiscard]] std::string_view source_commit();

/// The name of this computer; "unknown" when it has none.
[[nodiscard]] std::string host_name();

/// The processor's model: "AMD EPYC 7B13"; "unknown processor" when the system does not tell.
[[nodiscard]] std::string processor_model();

/// The processor's model and how many of them there are: "AMD EPYC 7B13, 2 processors".
[[nodiscard]] std::string processor();

/// Processors that this program may use, at least 1.
[[nodiscard]] unsigned processor_count();

/// This computer. Asked once.
[[nodiscard]] const Machine& this_machine();

/// Processes that run or wait to run, mean of the last minute; 0 when the system does not tell.
[[nodiscard]] double system_load();

}  // namespace downwash::bench
