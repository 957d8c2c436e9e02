#include <catch2/catch.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "downwash/base/csv_cell.hpp"
#include "downwash/base/csv_dialect.hpp"
#include "downwash/base/csv_reader.hpp"
#include "downwash/base/line_errors.hpp"

using namespace downwash;

namespace {

using Row = std::vector<std::string>;

/// What a reader finds in a text: the columns `z`, `k` and `note`.
struct Table {
    std::vector<double> z, k;
    std::vector<std::string> notes, comments;
    std::vector<std::size_t> lines;
    bool operator==(const Table&) const = default;
};

Table read(const std::string& bytes) {
    LineErrors errors("t.csv");
    CsvReader csv(bytes, errors, {1000, 10});
    const std::size_t z = csv.required("z", "z and k");
    const std::size_t k = csv.required("k", "z and k");
    errors.throw_any();
    const auto note = csv.find("note");
    Table table;
    while (csv.next()) {
        table.z.push_back(csv.number(z, -1e6, 1e6).value_or(0));
        table.k.push_back(csv.number(k).value_or(0));
        table.notes.emplace_back(note ? csv.cell(*note) : "");
        table.lines.push_back(csv.line());
    }
    for (const CsvReader::Comment& comment : csv.comments()) {
        table.comments.emplace_back(comment.text);
    }
    errors.throw_any();
    return table;
}

std::string error_of(const std::string& bytes) {
    return test::error_of([&bytes] {
        read(bytes);
        return 0;
    });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
        text.replace(at, from.size(), to);
    }
    return text;
}

/// ASCII, and the ø of Latin-1 given as UTF-8.
std::string encoded(const std::string& text, const std::string& encoding) {
    const std::string latin1 = replaced(text, "\xC3\xB8", "\xF8");
    if (encoding == "latin-1") {
        return latin1;
    }
    if (encoding.find("utf-16") == std::string::npos) {
        return (encoding == "utf-8 with mark" ? "\xEF\xBB\xBF" : "") + text;
    }
    const bool is_little = encoding.find("le") != std::string::npos;
    std::string bytes;
    if (encoding.find("mark") != std::string::npos) {
        bytes = is_little ? "\xFF\xFE" : "\xFE\xFF";
    }
    for (const char c : latin1) {
        bytes += is_little ? std::string{c, '\0'} : std::string{'\0', c};
    }
    return bytes;
}

}  // namespace

TEST_CASE("a table is the same in every dialect, encoding and with every end of line") {
    const Table expected{{0.5, 0.75, 1000}, {1.21, -0.0105, 2.5}, {"r\xC3\xB8r", "", "a"}, {"of a bench"}, {3, 4, 6}};
    const std::vector<Row> rows{
        {"z", "k", "note"}, {"0.5", "1.21", "r\xC3\xB8r"}, {"0.75", "-1.05e-2", ""}, {}, {"1000", "+2.5", "a"}};
    int read_tables = 0;
    for (const std::string separator : {",", ";", "\t", " ; ", ", "}) {
        for (const bool has_comma : {false, true}) {
            for (const bool has_quotes : {false, true}) {
                if (has_comma && !has_quotes && separator.find(',') != std::string::npos) {
                    continue;  // no one can read this
                }
                for (const std::string variant : {"plain", "empty last column", "index", "sep=", "blank rows"}) {
                    std::string text;
                    if (variant == "sep=") {
                        text += "sep=" + std::string(1, separator.find(';') != std::string::npos ? ';' : separator[0]);
                    } else {
                        text += "# of a bench";
                    }
                    int index = -1;
                    for (const Row& row : rows) {
                        text += '\n';
                        if (variant == "index" && !row.empty()) {
                            text += (index < 0 ? "" : std::to_string(index)) + separator;
                            ++index;
                        }
                        for (std::size_t i = 0; i < row.size(); ++i) {
                            const bool is_number = text.find("note") != std::string::npos && i < 2;
                            const std::string cell = is_number && has_comma ? replaced(row[i], ".", ",") : row[i];
                            text += (i > 0 ? separator : "") + (has_quotes ? '"' + cell + '"' : cell);
                        }
                        if (variant == "empty last column" && !row.empty()) {
                            text += separator;
                        }
                        if (variant == "blank rows" && row.empty()) {
                            text += separator + separator;
                        }
                    }
                    for (const std::string end : {"\n", "\r\n", "\r"}) {
                        for (const char* encoding : {"utf-8", "utf-8 with mark", "latin-1", "utf-16le with mark",
                                                     "utf-16be with mark", "utf-16le", "utf-16be"}) {
                            for (const bool has_last_end : {false, true}) {
                                CAPTURE(separator, has_comma, has_quotes, variant, end.size(), encoding, has_last_end);
                                Table wanted = expected;
                                if (variant == "sep=") {
                                    wanted.comments.clear();
                                }
                                const std::string bytes =
                                    encoded(replaced(text + (has_last_end ? "\n" : ""), "\n", end), encoding);
                                REQUIRE(read(bytes) == wanted);
                                ++read_tables;
                            }
                        }
                    }
                }
            }
        }
    }
    CHECK(read_tables == (5 * 4 - 2) * 5 * 3 * 7 * 2);
}

TEST_CASE("columns between blanks are read, however wide") {
    const Table table = read("  z     k\n  0.5   1.21  \n\t 10.25\t 1.1\r\n");
    CHECK(table.z == std::vector{0.5, 10.25});
    CHECK(table.k == std::vector{1.21, 1.1});
    CHECK(read("z k\n0,5 1,21\n").k == std::vector{1.21});
    CHECK(read("\"z\" \"k\" \"note\"\n0.5 1.21 \"a b\"\n").notes == std::vector<std::string>{"a b"});
}

TEST_CASE("the names may be a comment directly above the numbers, as numpy.savetxt writes them") {
    const Table table = read("# by hand\n# z k\n5.000000e-01 1.210000e+00\n1.0e+00 1.1e+00\n");
    CHECK(table.z == std::vector{0.5, 1.0});
    CHECK(table.comments == std::vector<std::string>{"by hand"});
    CHECK(table.lines == std::vector<std::size_t>{3, 4});
    CHECK(read("# z,k\n0.5;1.21\n").k == std::vector{1.21});
    // A comment of another length names nothing.
    CHECK(error_of("# from here\n# z k note\n1,2\n") ==
          "t.csv:3: has no column z in '1, 2': expected z and k\n"
          "t.csv:3: has no column k in '1, 2': expected z and k");
}

TEST_CASE("quoted cells hold separators, quotation marks and ends of lines") {
    const Table table = read("note,z,k\n\"a, \"\"b\"\"\nc \"\" d\",1,2\n13\" rotor,2,3\n\"\"\"\",3,4\n");
    CHECK(table.notes == std::vector<std::string>{"a, \"b\"\nc \" d", "13\" rotor", "\""});
    CHECK(table.lines == std::vector<std::size_t>{2, 4, 5});
    CHECK(error_of("z,k\n1,2\n\"1,2\n3,4\n") == "t.csv:3:1: this quotation mark opens a cell that none closes");
    CHECK(error_of("z,k\n1,\"2\"3\n") ==
          "t.csv:2:6: text follows a closing quotation mark: expected the end of the cell");
    // Other ends of lines within cells, and marks that are none, do not change what ends the lines.
    for (const std::string end : {"\n", "\r", "\r\n"}) {
        const Table other = read("# 13\" and" + end + "z,k,note" + end + "1,2,\"a\nb\"" + end + "3,4,\"c\rd\"" + end);
        CHECK(other.z == std::vector{1.0, 3.0});
        CHECK(other.k == std::vector{2.0, 4.0});
        CHECK(other.notes == std::vector<std::string>{"a\nb", "c\rd"});
        CHECK(other.comments == std::vector<std::string>{"13\" and"});
    }
    // The place of a cell is where it stands, also behind an end of line.
    CHECK(error_of("note,z,k\n\"a\nb\",1,x\n") == "t.csv:3:6: k is 'x': expected a finite number");
}

TEST_CASE("what the look of a number does not say is an error that says how to write it") {
    const std::string head = "z;k\n";
    CHECK(error_of(head + "1;1,234\n") ==
          "t.csv:2:3: k is '1,234', which may mean 1.234 or 1234: expected one of these; add a zero to "
          "its decimals, or leave out what stands between thousands");
    CHECK(error_of("z,k\n1,\"1,234\"\n") ==
          "t.csv:2:3: k is '1,234', which may mean 1.234 or 1234: expected one of these; add a zero to "
          "its decimals, or leave out what stands between thousands");
    CHECK(read(head + "1;1,234\n2;0,5\n").k == std::vector{1.234, 0.5});
    CHECK(read(head + "1;1.234\n").k == std::vector{1.234});
    CHECK(read(head + "1;0,750\n").k == std::vector{0.75});
    CHECK(
        error_of(head + "0.5;1,234\n") ==
        "t.csv:2:5: k is '1,234', with a comma, but a number in line 2 has a decimal point: expected one decimal sign "
        "in the whole file, and none between thousands");
    CHECK(
        error_of(head + "0,5;2\n1.234;2\n") ==
        "t.csv:3:1: z is '1.234', with a point, but a number in line 2 has a decimal comma: expected one decimal sign "
        "in the whole file, and none between thousands");
    CHECK(
        error_of(head + "1.234;1,234\n") ==
        "t.csv:2:7: k is '1,234', with a comma, but a number in line 2 has a decimal point: expected one decimal sign "
        "in the whole file, and none between thousands");
    CHECK(error_of(head + "1.234,5;2\n") == "t.csv:2:1: z is '1.234,5': expected a number from -1000000 to 1000000");
    // Decimal commas between commas: told once, though it is so in every line.
    CHECK(error_of("z,k\n0,5,1,21\n0,7,1,1\n0,9,1,0\n") ==
          "t.csv:2: holds 4 cells: expected 2, one for each column of line 1; if its numbers have decimal commas, "
          "separate the columns by ';' or quote the numbers");
    CHECK(read(head + "\xE2\x88\x92"
                      "0,5;1\n")
              .z == std::vector{-0.5});
}

TEST_CASE("what is no table is an error with its line") {
    const std::string no_table = "t.csv: holds no table: expected a line with the names of its columns, then rows";
    CHECK(error_of("") == no_table);
    CHECK(error_of("# only this\n;;;\n") == no_table);
    CHECK(error_of("z,k\na,2,3\n1\n") ==
          "t.csv:2: holds 3 cells: expected 2, one for each column of line 1\n"
          "t.csv:3: holds 1 cell: expected 2, one for each column of line 1");
    CHECK(error_of("z,k\n1;2\n3;4\n") ==
          "t.csv:2: holds 1 cell: expected 2, one for each column of line 1; separate it as "
          "the names, by ','");
    CHECK(error_of("z,k\n0.5 1.21\n0.7 1.1\n") ==
          "t.csv:2: holds 1 cell: expected 2, one for each column of line 1; separate it as "
          "the names, by ','");
    CHECK(error_of("z,k,z\n") == "t.csv:1:5: the column 'z' occurs twice");
    CHECK(error_of("z/R,K/1\n1,2\n") ==
          "t.csv:1: has no column z in 'z/R, K/1': expected z and k\n"
          "t.csv:1: has no column k in 'z/R, K/1': expected z and k");
    CHECK(read("Z,K,k2\n1,2,3\n").k == std::vector{2.0});
    CHECK(error_of("z,k\n1,nan\n2e6,inf\n") ==
          "t.csv:2:3: k is 'nan': expected a finite number\n"
          "t.csv:3:1: z is '2e6': expected a number from -1000000 to 1000000\n"
          "t.csv:3:5: k is 'inf': expected a finite number");
    CHECK(error_of(std::string("z,k\n1,2\0", 8)) == "t.csv: holds a zero byte: expected text");
    CHECK(error_of(std::string("\xFF\xFE\0\0z\0\0\0", 8)) == "t.csv: is UTF-32 text: expected UTF-8");
    CHECK(error_of("a,b,c,d,e,f,g,h,i,j,k\n") == "t.csv:1:21: more than 10 columns");
    std::string many = "z,k\n";
    for (int i = 0; i <= 1000; ++i) {
        many += "1,2\n";
    }
    CHECK(error_of(many) == "t.csv:1002: is row 1001: expected at most 1000");
    CHECK(error_of("z,k\n" + std::string(100000, ',')) == "none");  // a row without content
    std::string comments;
    for (int i = 0; i <= 1'000'000; ++i) {
        comments += "#\n";
    }
    CHECK(error_of(comments + "z,k\n1,2\n") == "t.csv:1000001: is comment 1000001: expected at most 1000000");
}

TEST_CASE("a number shows how finely it is written") {
    const auto check = [](const char* number, int decimals, int significant) {
        CAPTURE(number);
        const WrittenDigits digits = written_digits(number);
        CHECK(digits.decimals == decimals);
        CHECK(digits.significant == significant);
    };
    check("-0.0120", 4, 3);
    check("1.5e3", -2, 2);
    check("12", 0, 2);
    check("8,326312", 6, 7);
    check("1.234560e-01", 7, 7);
    check("0", 0, 0);
    check(".5", 1, 1);
    check("2.", 0, 1);
}

TEST_CASE("facts tell the dialect, the rows and which columns were read as numbers") {
    LineErrors errors("t.csv");
    CsvReader csv(";z;note;k;\n1;0,5;a;1,5;\n\n2;1;b;1,25;\n", errors, {1000, 10});
    CHECK(csv.facts().rows == 0);
    while (csv.next()) {
        CHECK(csv.number(csv.find("z").value()));
        CHECK(csv.number(csv.find("k").value()));
    }
    errors.throw_any();
    const CsvFacts facts = csv.facts();
    CHECK(facts.separator == ';');
    CHECK(facts.decimal_sign == ',');
    CHECK(facts.rows == 2);
    REQUIRE(facts.used.size() == 2);
    CHECK(facts.used[0].name == "z");
    CHECK(facts.used[0].low == 0.5);
    CHECK(facts.used[0].high == 1);
    CHECK(facts.used[1].name == "k");
    CHECK(facts.used[1].low == 1.25);
    CHECK(facts.used[1].high == 1.5);
    CHECK(facts.used[1].has_numbers());
    CHECK(facts.others == Row{"note"});
}

TEST_CASE("a column of words that was read is no other column and has no range") {
    LineErrors errors("t.csv");
    CsvReader csv("z,where,note\n1,a,b\n", errors, {1000, 10});
    csv.use(1);
    REQUIRE(csv.next());
    CHECK(csv.number(0) == 1.0);
    const CsvFacts facts = csv.facts();
    REQUIRE(facts.used.size() == 2);
    CHECK(facts.used[1].name == "where");
    CHECK_FALSE(facts.used[1].has_numbers());
    CHECK(facts.others == Row{"note"});
}

TEST_CASE("the range of a column tells decimals from thousands where only one of both is within") {
    LineErrors errors("t.csv");
    CsvReader csv("z;k\n1;1,058\n2;1,020\n", errors, {1000, 10});
    REQUIRE(csv.next());
    CHECK(csv.number(0, 0, 1000) == 1.0);
    CHECK(csv.number(1, 0, 100) == 1.058);
    REQUIRE(csv.next());
    CHECK(csv.number(1, 0, 100) == 1.02);
    errors.throw_any();
    CHECK(csv.facts().decimal_sign == ',');
    LineErrors of_large("t.csv");
    CsvReader large("k;n\n1,200;2\n", of_large, {1000, 10});
    REQUIRE(large.next());
    CHECK(large.number(0, 1000, 2000) == 1200.0);
}

TEST_CASE("names and numbers that are nearly right are errors with what to write") {
    using Catch::Contains;
    CHECK_THAT(error_of("z [-],k [%]\n1,2\n"),
               Contains("; write 'z [-]' as z") && Contains("; write 'k [%]' as k, and divide percent by 100"));
    CHECK_THAT(error_of("z|k\n1|2\n"), Contains("; separate columns by ';', tabs or ',', not by '|'"));
    CHECK_THAT(error_of("Stand 3\nz,k\n1,2\n"),
               Contains("; the names seem to stand in line 2: begin the lines above with #"));
    CHECK_THAT(error_of("z,k\nm,-\n1,2\n"),
               Contains("t.csv:2:1: z is 'm'") && Contains("; if this is a line of units, begin it with #"));
    CHECK_THAT(error_of("\"z\" \"k\"\n\"1\" 0.5 1.2\n\"2\" 1 1.1\n"), Contains("(row.names = FALSE)"));
    CHECK_THAT(error_of("z,k\n1,1'000\n"), Contains("; leave out its apostrophes"));
    CHECK_THAT(error_of("z,k\n1,1\xE2\x80\xAF"
                        "000\n"),
               Contains("U+202F"));
    CHECK_THAT(error_of("z,k\n1,1.21D0\n"), Contains("; write its exponent with 'e', not 'D'"));
    CHECK_THAT(error_of("z,k\n1,21%\n"), Contains("; divide percent by 100"));
    CHECK_THAT(error_of("z,k\n1,much\n"), !Contains(";"));
}

TEST_CASE("a text becomes one cell") {
    CHECK(csv_cell("plain") == "plain");
    CHECK(csv_cell("a,\"b\"") == "\"a,\"\"b\"\"\"");
}

TEST_CASE("errors of a file name their lines, and those beyond the twentieth are counted") {
    LineErrors errors("a.csv");
    errors.throw_any();
    errors.add(0, "is empty");
    errors.add(3, "is short");
    errors.add(4, 7, "is no number");
    CHECK_THROWS_WITH(errors.throw_any(), "a.csv: is empty\na.csv:3: is short\na.csv:4:7: is no number");
    for (std::size_t line = 4; line < 21; ++line) {
        errors.add(line, "is wrong");
    }
    const auto said = [&errors] { return test::error_of([&] { return errors.throw_any(), 0; }); };
    CHECK(said().ends_with("\na.csv:20: is wrong"));
    errors.add(21, "is wrong");
    CHECK(said().ends_with("\na.csv:20: is wrong\na.csv: and 1 more error"));
    errors.add(22, "is wrong");
    CHECK(said().ends_with("\na.csv:20: is wrong\na.csv: and 2 more errors"));
}
