#include "downwash/simulation/work_recorder.hpp"

#include <ctime>
#include <new>
#include <utility>

namespace downwash {

void WorkRecorder::add(WorkPiece piece) noexcept {
    const std::scoped_lock lock(mutex_);
    try {
        pieces_.push_back(std::move(piece));
    } catch (const std::bad_alloc&) {  // a record is not worth a search
    }
}

std::vector<WorkPiece> WorkRecorder::take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(pieces_, {});
}

double WorkRecorder::now_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

ParallelScope::~ParallelScope() {
    if (recorder_ != nullptr) {
        WorkPiece piece;
        piece.kind = WorkPiece::Kind::parallel;
        piece.items = items_;
        piece.begin_s = begin_s_;
        piece.end_s = WorkRecorder::now_s();
        recorder_->add(std::move(piece));
    }
}

}  // namespace downwash
