#pragma once

// Private to results/.

#include <functional>
#include <string>

#include "downwash/problems/located_error.hpp"
#include "downwash/problems/objective.hpp"
#include "downwash/results/json_reader.hpp"

namespace downwash::problems {

/// Opens a solution file and hands its root to `read`.
/// @param on_warning is told of the warnings that `read` gives to the reader, if there are no errors
/// @throws ProblemFileError with every error: those of the file itself, and those that `read` gives to the reader
void read_document(const std::string& path, const std::function<void(JsonReader&, const Node&)>& read,
                   const std::function<void(const LocatedError&)>& on_warning = {});

/// Reads `objective`: a name, or a group of weights. Left as it is where it is missing.
void read_objective(JsonReader& reader, const Node& root, CostFunction& objective);

}  // namespace downwash::problems
