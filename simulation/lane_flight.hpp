#pragma once

// What flights in lanes have in common, whatever the family of vehicles. Private: not installed.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "downwash/base/numbers.hpp"
#include "downwash/simulation/lane_rows.hpp"

namespace downwash::simulation {

/// One lane among those of a kernel: the job that it flies, and its part of the rows of all lanes. See LaneOf for what
/// families add.
template <class Job, class Chain>
class LaneFlight {
 public:
    [[nodiscard]] bool is_free() const noexcept { return job_ == nullptr; }

    /// The chain whose jobs the lane flies; nullptr for jobs that stand for themselves.
    [[nodiscard]] Chain* chain() const noexcept { return chain_; }
    void follow(Chain* chain) noexcept { chain_ = chain; }

    /// Whether the lane has numbers to compute with: those of its job, or else ordinary ones.
    [[nodiscard]] bool can_fly() const noexcept { return !is_free() || is_idle_; }

 protected:
    explicit LaneFlight(int number) noexcept : number_(number) {}

    void start(Job& job) noexcept {
        job_ = &job;
        leg_ = 0;
        first_tick_ = job.first_tick;
        is_idle_ = false;
    }
    /// Takes over another lane's job. That one keeps its numbers, which are ordinary ones.
    void take_job_of(LaneFlight& other) noexcept {
        job_ = std::exchange(other.job_, nullptr);
        chain_ = std::exchange(other.chain_, nullptr);
        leg_ = other.leg_;
        first_tick_ = other.first_tick_;
        is_idle_ = false;
        other.is_idle_ = true;
    }

    /// Copies another lane's part of a struct that has nothing but numbers and pointers in rows.
    template <class Rows>
    void copy_rows(const LaneFlight& other, Rows& rows) const noexcept {
        using Row = double[lane_count];
        static_assert(sizeof(Rows) % sizeof(Row) == 0);
        for (Row& row : std::span(reinterpret_cast<Row*>(&rows), sizeof(Rows) / sizeof(Row))) {
            row[number_] = row[other.number_];
        }
    }
    /// This lane's part of a struct.
    template <class Struct>
    [[nodiscard]] Struct read(const LaneRows<Struct>& rows) const noexcept {
        Struct all;
        for (int i = 0; i < number_count<double, Struct>; ++i) {
            set_number_at(all, i, rows[i][number_]);
        }
        return all;
    }
    template <class Struct>
    void write(const Struct& from, LaneRows<Struct>& rows) const noexcept {
        for (int i = 0; i < number_count<double, Struct>; ++i) {
            rows[i][number_] = number_at<double>(from, i);
        }
    }

    int number_;
    Job* job_ = nullptr;
    Chain* chain_ = nullptr;
    std::size_t leg_ = 0;
    std::int64_t first_tick_ = 0;
    bool is_idle_ = false;  ///< the numbers are those that another lane had
};

}  // namespace downwash::simulation
