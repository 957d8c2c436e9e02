#include "downwash/python/interruptible.hpp"

#include <chrono>

namespace downwash::python {

void Attendance::tell(std::function<void()> callback) {
    const std::scoped_lock lock(mutex_);
    if (is_last_told_) {
        callbacks_.pop_back();
    }
    callbacks_.push_back(std::move(callback));
    is_last_told_ = true;
    changed_.notify_one();
}

void Attendance::tell_each(std::function<void()> callback) {
    const std::scoped_lock lock(mutex_);
    callbacks_.push_back(std::move(callback));
    is_last_told_ = false;
    changed_.notify_one();
}

void Attendance::close() {
    const std::scoped_lock lock(mutex_);
    is_closed_ = true;
    changed_.notify_one();
}

void Attendance::wait() {
    for (;;) {
        std::vector<std::function<void()>> callbacks;
        bool is_closed = false;
        {
            const py::gil_scoped_release released;
            std::unique_lock lock(mutex_);
            changed_.wait_for(lock, std::chrono::milliseconds(20),
                              [this] { return is_closed_ || !callbacks_.empty(); });
            callbacks.swap(callbacks_);
            is_last_told_ = false;
            is_closed = is_closed_;
        }
        attend(callbacks);
        if (is_closed) {
            return;
        }
    }
}

void Attendance::attend(const std::vector<std::function<void()>>& callbacks) {
    try {
        if (raised_ || failure_) {
            return;
        }
        for (const std::function<void()>& callback : callbacks) {
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
    } catch (...) {  // as of a stop whose is_set() is no truth value
        failure_ = std::current_exception();
        interrupt_.request_stop();
    }
}

void Attendance::rethrow() const {
    if (raised_) {
        throw py::error_already_set(*raised_);
    }
    if (failure_) {
        std::rethrow_exception(failure_);
    }
}

}  // namespace downwash::python
