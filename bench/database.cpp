#include "downwash/bench/database.hpp"

#include <sqlite3.h>

#include <utility>

namespace downwash::bench {
namespace {

constexpr int patience_ms = 10000;  // while another program writes

[[noreturn]] void fail(const std::string& file, sqlite3* database) {
    throw DatabaseError(file + ": " + (database != nullptr ? sqlite3_errmsg(database) : "memory ran out"));
}

int flags_of(Database::Access access) {
    switch (access) {
        case Database::Access::read:
            return SQLITE_OPEN_READONLY;
        case Database::Access::write:
            return SQLITE_OPEN_READWRITE;
        case Database::Access::create:
            break;
    }
    return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, std::string file, std::string_view sql)
    : database_(database), file_(std::move(file)) {
    sqlite3_stmt* prepared = nullptr;
    check(sqlite3_prepare_v2(database, sql.data(), static_cast<int>(sql.size()), &prepared, nullptr));
    statement_.reset(prepared);
}

void Statement::check(int result) const {
    if (result != SQLITE_OK) {
        fail(file_, database_);
    }
}

Statement& Statement::bind(double value) {
    check(sqlite3_bind_double(statement_.get(), next_parameter_++, value));
    return *this;
}

Statement& Statement::bind(std::uint64_t value) {
    check(sqlite3_bind_int64(statement_.get(), next_parameter_++, static_cast<sqlite3_int64>(value)));
    return *this;
}

Statement& Statement::bind(std::string_view value) {
    check(sqlite3_bind_text64(statement_.get(), next_parameter_++, value.data(), value.size(), SQLITE_TRANSIENT,
                              SQLITE_UTF8));
    return *this;
}

Statement& Statement::bind(std::nullptr_t) {
    check(sqlite3_bind_null(statement_.get(), next_parameter_++));
    return *this;
}

bool Statement::step() {
    const int result = sqlite3_step(statement_.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) {
        fail(file_, database_);
    }
    return result == SQLITE_ROW;
}

void Statement::run() {
    while (step()) {
    }
    check(sqlite3_reset(statement_.get()));
    next_parameter_ = 1;
}

bool Statement::is_null(int column) const {
    return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

double Statement::number(int column) const {
    const int type = sqlite3_column_type(statement_.get(), column);
    if (type != SQLITE_FLOAT && type != SQLITE_INTEGER) {
        throw DatabaseError(file_ + ": a number is missing: another program wrote into this file");
    }
    return sqlite3_column_double(statement_.get(), column);
}

std::uint64_t Statement::integer(int column) const {
    const sqlite3_int64 value = sqlite3_column_int64(statement_.get(), column);
    if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER || value < 0) {
        throw DatabaseError(file_ + ": a whole number is missing: another program wrote into this file");
    }
    return static_cast<std::uint64_t>(value);
}

std::string Statement::text(int column) const {
    const unsigned char* text = sqlite3_column_text(statement_.get(), column);
    if (text == nullptr) {
        throw DatabaseError(file_ + ": a text is missing: another program wrote into this file");
    }
    return {reinterpret_cast<const char*>(text),
            static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::optional<double> Statement::optional_number(int column) const {
    return is_null(column) ? std::nullopt : std::optional(number(column));
}

std::optional<std::uint64_t> Statement::optional_integer(int column) const {
    return is_null(column) ? std::nullopt : std::optional(integer(column));
}

std::optional<std::string> Statement::optional_text(int column) const {
    return is_null(column) ? std::nullopt : std::optional(text(column));
}

void Database::Close::operator()(sqlite3* database) const {
    sqlite3_close(database);
}

Database::Database(const std::filesystem::path& file, Access access) : file_(file.string()) {
    sqlite3* opened = nullptr;
    const int result = sqlite3_open_v2(file_.c_str(), &opened, flags_of(access), nullptr);
    database_.reset(opened);
    if (result != SQLITE_OK) {
        fail(file_, opened);
    }
    sqlite3_busy_timeout(opened, patience_ms);
    execute("PRAGMA foreign_keys = ON");
}

void Database::execute(const std::string& sql) const {
    if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
        fail(file_, database_.get());
    }
}

std::uint64_t Database::last_key() const {
    return static_cast<std::uint64_t>(sqlite3_last_insert_rowid(database_.get()));
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
