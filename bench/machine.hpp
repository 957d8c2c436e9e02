#pragma once

#include <string>
#include <string_view>

namespace downwash::bench {

/// The commit that this program was built from, with "-dirty" where tracked files differed; "unknown" where there is no
/// repository.
[[nodiscard]] std::string_view source_commit();

/// The name of this computer; "unknown" when it has none.
[[nodiscard]] std::string host_name();

/// The processor's model and how many of them there are: "AMD EPYC 7B13, 2 processors".
[[nodiscard]] std::string processor();

/// Processors that this program may use, at least 1.
[[nodiscard]] unsigned processor_count();

}  // namespace downwash::bench
