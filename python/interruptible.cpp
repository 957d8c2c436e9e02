#include "downwash/python/interruptible.hpp"

#include <chrono>

namespace downwash::python {

void Attendance::tell(std::function<void()> callback) {
    const std::scoped_lock lock(mutex_);
    callback_ = std::move(callback);
    changed_.notify_one();
}

void Attendance::close() {
    const std::scoped_lock lock(mutex_);
    is_closed_ = true;
    changed_.notify_one();
}

void Attendance::wait() {
    for (;;) {
        std::function<void()> callback;
        bool is_closed = false;
        {
            const py::gil_scoped_release released;
            std::unique_lock lock(mutex_);
            changed_.wait_for(lock, std::chrono::milliseconds(20), [this] { return is_closed_ || callback_; });
            callback.swap(callback_);
            is_closed = is_closed_;
        }
        attend(callback);
        if (is_closed) {
            return;
        }
    }
}

void Attendance::attend(const std::function<void()>& callback) {
    try {
        if (raised_) {
            return;
        }
        if (callback) {
            callback();
        }
        if (PyErr_CheckSignals() != 0) {
            throw py::error_already_set();
        }
        if (!stop_.is_none() && stop_.attr("is_set")().cast<bool>()) {
            interrupt_.request_stop();
        }
    } catch (py::error_already_set& error) {
        raised_.emplace(error);
        interrupt_.request_stop();
    }
}

void Attendance::rethrow() const {
    if (raised_) {
        throw py::error_already_set(*raised_);
    }
}

}  // namespace downwash::python
