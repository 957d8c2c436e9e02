#include "downwash/bench/database.hpp"

#include <sqlite3.h>

namespace downwash::bench {

void Database::Close::operator()(sqlite3* database) const {
    sqlite3_close(database);
}

void Database::Close::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Database::Database(const std::filesystem::path& file, bool creates) : file_(file.string()) {
    constexpr int waiting_ms = 10000;  // while another program writes
    sqlite3* opened = nullptr;
    // For reading too: only a connection that may write can take back what a killed program left half written. SQLite
    // opens a file that is write-protected for reading.
    const int result =
        sqlite3_open_v2(file_.c_str(), &opened, SQLITE_OPEN_READWRITE | (creates ? SQLITE_OPEN_CREATE : 0), nullptr);
    database_.reset(opened);
    check(result);
    sqlite3_busy_timeout(opened, waiting_ms);
    execute("PRAGMA foreign_keys = ON");
}

std::uint64_t Database::number(std::string_view sql) const {
    std::uint64_t found = 0;
    if (const Statement row = prepare(sql); step(row)) {
        read(row, 0, found);
    }
    return found;
}

void Database::execute(const std::string& sql) const {
    check(sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::uint64_t Database::last_key() const {
    return static_cast<std::uint64_t>(sqlite3_last_insert_rowid(database_.get()));
}

Database::Statement Database::prepare(std::string_view sql) const {
    sqlite3_stmt* prepared = nullptr;
    check(sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &prepared, nullptr));
    return Statement(prepared);
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
    const int type = sqlite3_column_type(row.get(), column);
    require(type == SQLITE_FLOAT || type == SQLITE_INTEGER, "number");
    value = sqlite3_column_double(row.get(), column);
}

void Database::read(const Statement& row, int column, std::uint64_t& value) const {
    const sqlite3_int64 found = sqlite3_column_int64(row.get(), column);
    require(sqlite3_column_type(row.get(), column) == SQLITE_INTEGER && found >= 0, "whole number");
    value = static_cast<std::uint64_t>(found);
}

void Database::read(const Statement& row, int column, std::string& value) const {
    require(sqlite3_column_type(row.get(), column) == SQLITE_TEXT, "text");
    value.assign(reinterpret_cast<const char*>(sqlite3_column_text(row.get(), column)),
                 static_cast<std::size_t>(sqlite3_column_bytes(row.get(), column)));
}

void Database::require(bool is_right, const char* name) const {
    if (!is_right) {
        throw DatabaseError(file_ + ": a " + name + " is missing: another program wrote into this file");
    }
}

void Database::check(int result) const {
    if (result != SQLITE_OK) {
        fail();
    }
}

void Database::fail() const {
    throw DatabaseError(file_ + ": " + (database_ != nullptr ? sqlite3_errmsg(database_.get()) : "out of memory"));
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
