#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace downwash::bench {

/// A file of results cannot be used; what() names it and says why.
struct DatabaseError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A prepared statement of SQL. Parameters and columns are counted from 0.
class Statement {
 public:
    /// Sets the next parameter; the order is that of the question marks.
    Statement& bind(double value);
    Statement& bind(std::uint64_t value);
    Statement& bind(std::string_view value);
    Statement& bind(std::nullptr_t);
    template <class Value>
    Statement& bind(const std::optional<Value>& value) {
        return value ? bind(*value) : bind(nullptr);
    }

    /// The next row of the answer, or false at its end. @throws DatabaseError
    bool step();
    /// Runs the statement to its end and makes it ready for other parameters.
    void run();

    [[nodiscard]] bool is_null(int column) const;
    /// @throws DatabaseError where another type stands, which only other programs can have written
    [[nodiscard]] double number(int column) const;
    [[nodiscard]] std::uint64_t integer(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::optional<double> optional_number(int column) const;
    [[nodiscard]] std::optional<std::uint64_t> optional_integer(int column) const;
    [[nodiscard]] std::optional<std::string> optional_text(int column) const;

 private:
    friend class Database;
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    Statement(sqlite3* database, std::string file, std::string_view sql);
    void check(int result) const;

    sqlite3* database_;
    std::string file_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    int next_parameter_ = 1;
};

/// One SQLite file. Every statement is committed at once unless a Transaction lives.
class Database {
 public:
    enum class Access { read, write, create };

    /// @throws DatabaseError when there is none, or it is no database
    Database(const std::filesystem::path& file, Access access);

    [[nodiscard]] Statement prepare(std::string_view sql) const { return {database_.get(), file_, sql}; }
    /// Runs one or more statements without parameters. @throws DatabaseError
    void execute(const std::string& sql) const;
    /// Key of the row that was inserted last.
    [[nodiscard]] std::uint64_t last_key() const;

 private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    std::string file_;
    std::unique_ptr<sqlite3, Close> database_;
};

/// All that is written while it lives, or none of it.
class Transaction {
 public:
    explicit Transaction(const Database& database) : database_(database) { database_.execute("BEGIN IMMEDIATE"); }
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

 private:
    const Database& database_;
    bool is_open_ = true;
};

}  // namespace downwash::bench
