#include <optional>
#include <vector>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/stop_condition.hpp"
#include "downwash/base/whole_folder.hpp"
#include "downwash/python/core.hpp"
#include "downwash/results/run_folder.hpp"

namespace downwash::python {
namespace {

/// Raises an exception of downwash.errors. @param errors as (file, line, column, message)
void raise_as(const char* type, const char* text, const py::list& errors = py::list()) {
    const py::object of = py::module_::import("downwash.errors").attr(type);
    PyErr_SetObject(of.ptr(), of(text, errors).ptr());
}

void raise_as(const char* type, const ProblemFileError& error) {
    py::list errors;
    for (const LocatedError& each : error.errors()) {
        errors.append(py::make_tuple(each.file, each.line, each.column, each.message));
    }
    raise_as(type, error.what(), errors);
}

void raise_as(const char* type, const InputError& error) {
    py::list errors;
    for (const KeyError& each : error.errors()) {
        const std::string text = each.key.empty() ? each.message : each.key + " " + each.message;
        errors.append(py::make_tuple(py::none(), py::none(), py::none(), text));
    }
    raise_as(type, error.what(), errors);
}

}  // namespace

void bind_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) {
                std::rethrow_exception(thrown);
            }
        } catch (const ProblemFileError& error) {
            raise_as("ProblemError", error);
        } catch (const InputError& error) {
            raise_as("InputError", error);
        } catch (const OtherRunError& error) {
            raise_as("OtherRunError", error.what());
        } catch (const FolderError& error) {
            raise_as("FolderError", error.what());
        } catch (const FileError& error) {
            PyErr_SetString(PyExc_OSError, error.what());
        } catch (const WorkStopped& error) {
            raise_as("Stopped", error.what());
        }
    });
}

}  // namespace downwash::python
