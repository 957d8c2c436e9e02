#pragma once

// Private to aeromap.

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace downwash {

/// A numbered set of blocks, each made when somebody first asks for it, and then kept. Safe to share between threads.
///
/// A block has to be a pure function of its number: then nothing depends on who asks first, nor on which thread makes
/// it. What a block holds, and what its number stands for, is the user's affair: of a map, 8 x 8
/// cells of a plane.
///
/// A thread that asks for a block while another one makes it waits for it. To make it twice would be as right, but the
/// flights of a batch begin at the same place, so that threads would make the same blocks one after the other and be
/// no faster than one. try_make() is for the time of waiting.
template <class Block>
class BlockStore {
 public:
    /// @param count how many blocks there are; none is made yet
    explicit BlockStore(std::size_t count) : slots_(count, nullptr), owners_(count), is_new_(count, 0) {}

    [[nodiscard]] std::size_t size() const noexcept { return slots_.size(); }

    /// A place for each block, null until the block is made. Another thread may fill it at any time: read it by an
    /// atomic load that acquires.
    [[nodiscard]] const Block* const* slots() const noexcept { return slots_.data(); }

    /// A block that has been made; else nullptr.
    [[nodiscard]] const Block* find(std::size_t number) const noexcept {
        return __atomic_load_n(&slots_[number], __ATOMIC_ACQUIRE);
    }

    /// A block, made if nobody has made it yet. Waits if another thread is making it.
    /// @param make gives the block as std::shared_ptr<const Block>; what it throws is thrown here, and the block can be
    /// asked for again
    /// @param twins numbers of other blocks: if one of them has equal content (==), both are kept as one
    template <class Make>
    const Block& get(std::size_t number, const Make& make, std::span<const std::size_t> twins = {}) {
        if (const Block* known = find(number)) {
            return *known;
        }
        std::unique_lock lock(mutex_);
        made_.wait(lock, [&] { return !is_being_made(number); });
        if (owners_[number] == nullptr) {
            make_unlocked(number, make, twins, lock);
        }
        return *owners_[number];
    }

    /// Makes a block unless it is there, or another thread is making it. @return whether it was made here
    template <class Make>
    bool try_make(std::size_t number, const Make& make, std::span<const std::size_t> twins = {}) {
        std::unique_lock lock(mutex_);
        if (owners_[number] != nullptr || is_being_made(number)) {
            return false;
        }
        make_unlocked(number, make, twins, lock);
        return true;
    }

    /// Whether some thread is making a block now.
    [[nodiscard]] bool is_in_the_making(std::size_t number) const {
        const std::scoped_lock lock(mutex_);
        return is_being_made(number);
    }

    /// Puts a block that was made elsewhere in its place, unless there is one already.
    void put(std::size_t number, std::shared_ptr<const Block> block, std::span<const std::size_t> twins = {}) {
        const std::scoped_lock lock(mutex_);
        if (owners_[number] == nullptr) {
            publish(number, std::move(block), twins);
            is_new_[number] = 0;
        }
    }

    /// The block, to be kept elsewhere as well; empty if it has not been made.
    [[nodiscard]] std::shared_ptr<const Block> share(std::size_t number) const {
        const std::scoped_lock lock(mutex_);
        return owners_[number];
    }

    /// The numbers of all blocks that are there, in their order.
    [[nodiscard]] std::vector<std::size_t> made() const {
        const std::scoped_lock lock(mutex_);
        return numbers_where([this](std::size_t number) { return owners_[number] != nullptr; });
    }

    /// The numbers of the blocks that were made here since the last call, in their order: all but those of put().
    [[nodiscard]] std::vector<std::size_t> take_new() {
        const std::scoped_lock lock(mutex_);
        std::vector<std::size_t> numbers = numbers_where([this](std::size_t number) { return is_new_[number] != 0; });
        std::fill(is_new_.begin(), is_new_.end(), std::uint8_t{0});
        return numbers;
    }

 private:
    [[nodiscard]] bool is_being_made(std::size_t number) const {
        return std::find(in_the_making_.begin(), in_the_making_.end(), number) != in_the_making_.end();
    }

    template <class IsIn>
    [[nodiscard]] std::vector<std::size_t> numbers_where(const IsIn& is_in) const {
        std::vector<std::size_t> numbers;
        for (std::size_t number = 0; number < owners_.size(); ++number) {
            if (is_in(number)) {
                numbers.push_back(number);
            }
        }
        return numbers;
    }

    /// Makes a block while the lock is open, so that other threads can make other blocks.
    template <class Make>
    void make_unlocked(std::size_t number, const Make& make, std::span<const std::size_t> twins,
                       std::unique_lock<std::mutex>& lock) {
        in_the_making_.push_back(number);
        lock.unlock();
        const auto end_making = [&] {
            in_the_making_.erase(std::find(in_the_making_.begin(), in_the_making_.end(), number));
            made_.notify_all();
        };
        std::shared_ptr<const Block> block;
        try {
            block = make(number);
        } catch (...) {
            lock.lock();
            end_making();
            throw;
        }
        lock.lock();
        publish(number, std::move(block), twins);
        is_new_[number] = 1;
        end_making();
    }

    /// The mutex orders equal blocks: the later one finds the earlier, so that which are one does not depend on time.
    void publish(std::size_t number, std::shared_ptr<const Block> block, std::span<const std::size_t> twins) {
        for (const std::size_t twin : twins) {
            if (twin != number && owners_[twin] != nullptr && *owners_[twin] == *block) {
                block = owners_[twin];
                break;
            }
        }
        owners_[number] = std::move(block);
        __atomic_store_n(&slots_[number], owners_[number].get(), __ATOMIC_RELEASE);
    }

    std::vector<const Block*> slots_;  ///< read by everybody, by atomic loads
    mutable std::mutex mutex_;         ///< guards everything below, and writing to slots_
    std::condition_variable made_;
    std::vector<std::shared_ptr<const Block>> owners_;
    std::vector<std::uint8_t> is_new_;        ///< 1: made here, and not yet taken by take_new()
    std::vector<std::size_t> in_the_making_;  ///< a few: one for each thread
};

}  // namespace downwash
