#pragma once

#include <pybind11/pybind11.h>

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace downwash::python {

namespace py = pybind11;

/// Long work on a thread of its own, while the calling thread waits for it without the interpreter lock, runs
/// callbacks, and looks for signals and for a wish to stop fifty times a second.
class Attendance {
 public:
    /// @param stop None, or an object whose is_set() says whether the work is to end: a threading.Event
    explicit Attendance(py::object stop) : stop_(std::move(stop)) {}

    [[nodiscard]] std::stop_token token() const { return interrupt_.get_token(); }

    /// From the working thread: has the calling thread run a callback with the interpreter lock. Where it is busy, a
    /// newer callback takes the place of one that waits.
    void tell(std::function<void()> callback);
    /// Tells Python of something by a callback of which none may be missed: it runs after those that wait.
    void tell_each(std::function<void()> callback);
    /// From the working thread: there is nothing more to wait for.
    void close();

    /// Returns after close(). What Python raises meanwhile asks the work to stop. @pre the interpreter lock is held
    void wait();
    /// Throws on what Python has raised.
    void rethrow() const;

 private:
    void attend(const std::vector<std::function<void()>>& callbacks);

    py::object stop_;
    std::stop_source interrupt_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::function<void()>> callbacks_;  ///< callbacks that wait
    bool is_last_told_ = false;                     ///< whether the last one was told by tell()
    bool is_closed_ = false;
    std::optional<py::error_already_set> raised_;
    std::exception_ptr failure_;  ///< our failure while Python was asked
};

/// Runs work(attendance) as Attendance says. Work must not touch Python but through Attendance::tell().
/// @return what work returns   @throws what work throws, or Python raises: KeyboardInterrupt above all
template <class Work>
auto interruptible(const py::object& stop, const Work& work) {
    Attendance attendance(stop);
    std::optional<decltype(work(attendance))> result;
    std::exception_ptr failure;
    {
        std::jthread worker([&] {
            try {
                result.emplace(work(attendance));
            } catch (...) {
                failure = std::current_exception();
            }
            attendance.close();
        });
        attendance.wait();
    }
    attendance.rethrow();
    if (failure) {
        std::rethrow_exception(failure);
    }
    return std::move(*result);
}

}  // namespace downwash::python
