#include "downwash/bench/database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <new>
#include <system_error>

namespace downwash::bench {

void Database::Close::operator()(sqlite3* database) const {
    sqlite3_close(database);
}

void Database::Close::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

namespace {

/// The size of a file that is there. @throws DatabaseError when it is no ordinary file or too large
std::uint64_t checked_size(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        return 0;  // SQLite says so, or makes it
    }
    if (!std::filesystem::is_regular_file(file, error)) {
        throw DatabaseError(file.string() + ": is no ordinary file: expected the results of a campaign");
    }
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (error || bytes > max_database_bytes) {
        throw DatabaseError(file.string() + ": is larger than " + std::to_string(max_database_bytes >> 20U) +
                            " MiB, more than any campaign writes: split the campaign, for example by its seeds");
    }
    return bytes;
}

/// What to do about an error of SQLite, as the end of its message.
std::string remedy_for(int code) {
    switch (code & 0xff) {
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
            return ". The file is damaged: restore it from a copy, or run the campaign again into another folder";
        case SQLITE_INTERRUPT:
            return ": it takes longer to read than a file of its size can. It is damaged or not written by `downwash "
                   "bench run`: restore it from a copy, or run the campaign again into another folder";
        case SQLITE_READONLY:
        case SQLITE_CANTOPEN:
            return ". If a program was killed while it wrote, what it left half written has to be taken back first: "
                   "make the file and its folder writable, or copy the whole folder and use the copy";
        case SQLITE_FULL:
            return ". A file of results has at most " + std::to_string(max_database_bytes >> 20U) +
                   " MiB: free space on the disk, or split the campaign, for example by its seeds";
        case SQLITE_TOOBIG:
            return ". A text in a file of results has at most " + std::to_string(max_database_text_bytes >> 20) +
                   " MiB: the file is damaged or not written by `downwash bench run`";
        default:
            return "";
    }
}

constexpr int work_between_questions = 1000;

}  // namespace

Database::Database(const std::filesystem::path& file, bool creates)
    : file_(file.string()), work_left_(std::make_unique<std::uint64_t>(0)) {
    constexpr int waiting_ms = 10000;  // while another program writes
    // A row takes ten bytes or more, and far less than a hundred steps of SQLite's virtual machine.
    constexpr std::uint64_t work_per_byte = 10;
    constexpr std::uint64_t work_of_small_files = 10'000'000;
    max_work_ = work_of_small_files + work_per_byte * checked_size(file);
    *work_left_ = max_work_;
    sqlite3* opened = nullptr;
    // For reading too: only a connection that may write can take back what a killed program left half written. SQLite
    // opens a file that is write-protected for reading.
    constexpr int one_thread_at_a_time = SQLITE_OPEN_NOMUTEX;  // see the class
    const int result =
        sqlite3_open_v2(file_.c_str(), &opened,
                        SQLITE_OPEN_READWRITE | one_thread_at_a_time | (creates ? SQLITE_OPEN_CREATE : 0), nullptr);
    database_.reset(opened);
    check(result);
    sqlite3_busy_timeout(opened, waiting_ms);
    protect();
    execute("PRAGMA foreign_keys = ON");
}

void Database::wait_for_others(std::chrono::milliseconds at_most) const {
    sqlite3_busy_timeout(database_.get(), static_cast<int>(at_most.count()));
}

/// Whatever the file contains: see the class.
void Database::protect() {
    constexpr std::uint64_t page_bytes = 4096;  // of the files that we make
    sqlite3* const database = database_.get();
    sqlite3_extended_result_codes(database, 1);
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, max_database_text_bytes);
    sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
    check(sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr));
    check(sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr));
    const auto count = [](void* left) {
        auto& work = *static_cast<std::uint64_t*>(left);
        work -= std::min<std::uint64_t>(work, work_between_questions);
        return work == 0 ? 1 : 0;
    };
    sqlite3_progress_handler(database, work_between_questions, count, work_left_.get());
    execute("PRAGMA cell_size_check = ON");
    execute("PRAGMA max_page_count = " + std::to_string(max_database_bytes / page_bytes));
}

std::uint64_t Database::number(std::string_view sql) const {
    std::uint64_t found = 0;
    if (const Statement row = prepare(sql); step(row)) {
        read(row, 0, found);
    }
    return found;
}

void Database::execute(const std::string& sql) const {
    *work_left_ = max_work_;
    check(sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::uint64_t Database::last_key() const {
    return static_cast<std::uint64_t>(sqlite3_last_insert_rowid(database_.get()));
}

Database::Statement Database::prepare(std::string_view sql) const {
    sqlite3_stmt* prepared = nullptr;
    *work_left_ = max_work_;
    check(sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &prepared, nullptr));
    return Statement(prepared);
}

const Database::Statement& Database::kept(std::string_view sql) const {
    auto found = kept_.find(sql);
    if (found == kept_.end()) {
        found = kept_.emplace(std::string(sql), prepare(sql)).first;
    }
    *work_left_ = max_work_;
    return found->second;
}

Database::Prepared::~Prepared() {
    sqlite3_reset(statement_.get());  // an error of the statement was reported when it was run
    sqlite3_clear_bindings(statement_.get());
}

bool Database::step(const Statement& statement) const {
    const int result = sqlite3_step(statement.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) {
        fail();
    }
    return result == SQLITE_ROW;
}

void Database::bind(const Statement& statement, int parameter, double value) const {
    check(sqlite3_bind_double(statement.get(), parameter, value));
}

void Database::bind(const Statement& statement, int parameter, std::uint64_t value) const {
    check(sqlite3_bind_int64(statement.get(), parameter, static_cast<sqlite3_int64>(value)));
}

void Database::bind(const Statement& statement, int parameter, std::string_view value) const {
    check(sqlite3_bind_text64(statement.get(), parameter, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

bool Database::is_null(const Statement& row, int column) const {
    return sqlite3_column_type(row.get(), column) == SQLITE_NULL;
}

void Database::read(const Statement& row, int column, double& value) const {
    value = sqlite3_column_double(row.get(), column);
}

void Database::read(const Statement& row, int column, std::uint64_t& value) const {
    value = static_cast<std::uint64_t>(sqlite3_column_int64(row.get(), column));
}

void Database::read(const Statement& row, int column, std::string& value) const {
    const unsigned char* text = sqlite3_column_text(row.get(), column);
    value.assign(reinterpret_cast<const char*>(text),
                 text != nullptr ? static_cast<std::size_t>(sqlite3_column_bytes(row.get(), column)) : 0);
}

void Database::check(int result) const {
    if (result != SQLITE_OK) {
        fail();
    }
}

void Database::fail() const {
    if (database_ == nullptr) {
        throw std::bad_alloc();
    }
    const int code = sqlite3_extended_errcode(database_.get());
    if (code == SQLITE_NOMEM) {
        throw std::bad_alloc();
    }
    throw DatabaseError(file_ + ": " + sqlite3_errmsg(database_.get()) + remedy_for(code));
}

Transaction::~Transaction() {
    if (is_open_) {
        try {
            database_.execute("ROLLBACK");
        } catch (const DatabaseError&) {  // NOLINT(bugprone-empty-catch): SQLite rolls back when the file is closed
        }
    }
}

void Transaction::commit() {
    database_.execute("COMMIT");
    is_open_ = false;
}

}  // namespace downwash::bench
