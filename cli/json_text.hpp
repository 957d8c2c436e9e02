#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace downwash::cli {

/// A document as commands print it with --json. Text from files may be any bytes; what is no UTF-8 in it is replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& document);

}  // namespace downwash::cli
