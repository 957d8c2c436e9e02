#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace downwash::bench {

/// A file of results cannot be used; what() names it and says why.
struct DatabaseError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file of results grows no larger, and larger ones are not read [bytes].
inline constexpr std::uint64_t max_database_bytes = std::uint64_t{1} << 32U;
/// A text in such a file is no longer [bytes].
inline constexpr int max_database_text_bytes = 1 << 24U;

/// One SQLite file. Every statement is committed at once, unless a Transaction lives. Values are double,
/// std::uint64_t, text and optional ones of these, which are NULL when empty. A file may come from anybody: neither its
/// schema nor its content makes a statement run code or take longer than the file is large. For one thread at a time.
class Database {
 public:
    /// Opens a file. @throws DatabaseError when it does not exist, unless it is to be created, or is no database or too
    /// large
    explicit Database(const std::filesystem::path& file, bool creates = false);

    /// How long a statement waits for other programs that read or write the file: ten seconds unless told.
    void wait_for_others(std::chrono::milliseconds at_most) const;

    /// Runs one statement; the values are those of its question marks.
    template <class... Values>
    void run(std::string_view sql, const Values&... values) const {
        const Prepared prepared(*this, sql);
        int parameter = 0;
        (bind(prepared.statement(), ++parameter, values), ...);
        while (step(prepared.statement())) {
        }
    }

    /// Inserts a row. @param into a table, and in parentheses its columns unless all are given
    template <class... Values>
    void insert(const std::string& into, const Values&... values) const {
        std::string marks;
        ((static_cast<void>(values), marks += marks.empty() ? "?" : ", ?"), ...);
        run("INSERT INTO " + into + " VALUES (" + marks + ")", values...);
    }

    /// Inserts rows, several by each statement.
    template <class... Values>
    void insert_rows(const std::string& into, const std::vector<std::tuple<Values...>>& rows) const {
        constexpr std::size_t most = 16;
        for (std::size_t begin = 0; begin < rows.size(); begin += most) {
            const std::size_t end = std::min(begin + most, rows.size());
            std::string sql = "INSERT INTO " + into + " VALUES ";
            for (std::size_t i = begin; i < end; ++i) {
                sql += i == begin ? "(?" : ", (?";
                for (std::size_t value = 1; value < sizeof...(Values); ++value) {
                    sql += ", ?";
                }
                sql += ")";
            }
            const Prepared prepared(*this, sql);
            int parameter = 0;
            for (std::size_t i = begin; i < end; ++i) {
                std::apply([&](const auto&... values) { (bind(prepared.statement(), ++parameter, values), ...); },
                           rows[i]);
            }
            while (step(prepared.statement())) {
            }
        }
    }

    /// Calls take(column...) for every row of an answer. A value of another type than its column is converted, and is
    /// 0 or empty where it cannot be: checksums tell what was not written by us.
    template <class... Columns, class Take>
    void for_each(std::string_view sql, const Take& take) const {
        const Statement row = prepare(sql);
        while (step(row)) {
            std::tuple<Columns...> values;
            int column = 0;
            std::apply([&](auto&... value) { (read(row, column++, value), ...); }, values);
            std::apply(take, std::move(values));
        }
    }

    /// The first column of the first row of an answer; 0 without a row.
    [[nodiscard]] std::uint64_t number(std::string_view sql) const;

    /// Runs several statements without values.
    void execute(const std::string& sql) const;

    /// Its name, for messages.
    [[nodiscard]] const std::string& file() const noexcept { return file_; }

    /// Key of the row that was inserted last.
    [[nodiscard]] std::uint64_t last_key() const;

 private:
    struct Close {
        void operator()(sqlite3* database) const;
        void operator()(sqlite3_stmt* statement) const;
    };
    using Statement = std::unique_ptr<sqlite3_stmt, Close>;

    /// A statement that is kept for the next run() of the same text, during one of these.
    class Prepared {
     public:
        Prepared(const Database& database, std::string_view sql) : statement_(database.kept(sql)) {}
        ~Prepared();
        Prepared(const Prepared&) = delete;
        Prepared& operator=(const Prepared&) = delete;
        [[nodiscard]] const Statement& statement() const { return statement_; }

     private:
        const Statement& statement_;
    };

    [[nodiscard]] Statement prepare(std::string_view sql) const;
    [[nodiscard]] const Statement& kept(std::string_view sql) const;
    [[nodiscard]] bool step(const Statement& statement) const;
    void bind(const Statement& statement, int parameter, double value) const;
    void bind(const Statement& statement, int parameter, std::uint64_t value) const;
    void bind(const Statement& statement, int parameter, std::string_view value) const;
    template <class Value>
    void bind(const Statement& statement, int parameter, const std::optional<Value>& value) const {
        if (value) {  // NULL otherwise, as without a value
            bind(statement, parameter, *value);
        }
    }

    [[nodiscard]] bool is_null(const Statement& row, int column) const;
    void read(const Statement& row, int column, double& value) const;
    void read(const Statement& row, int column, std::uint64_t& value) const;
    void read(const Statement& row, int column, std::string& value) const;
    template <class Value>
    void read(const Statement& row, int column, std::optional<Value>& value) const {
        if (!is_null(row, column)) {
            read(row, column, value.emplace());
        }
    }

    void protect();
    void check(int result) const;
    [[noreturn]] void fail() const;

    std::string file_;
    std::uint64_t max_work_ = 0;                ///< most work of one statement, in steps of SQLite's virtual machine
    std::unique_ptr<std::uint64_t> work_left_;  ///< work left to the present statement
    std::unique_ptr<sqlite3, Close> database_;
    mutable std::map<std::string, Statement, std::less<>> kept_;  ///< by their texts
};

/// All that is written during its lifetime, or none of it. All that is read is of one moment.
class Transaction {
 public:
    enum class Kind : std::uint8_t { reading, writing };
    explicit Transaction(const Database& database, Kind kind = Kind::writing) : database_(database) {
        database_.execute(kind == Kind::writing ? "BEGIN IMMEDIATE" : "BEGIN");
    }
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

 private:
    const Database& database_;
    bool is_open_ = true;
};

}  // namespace downwash::bench
