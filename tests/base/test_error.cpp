#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"

using downwash::InputError;

TEST_CASE("An input error carries its errors and shows each on a line of its own") {
    const InputError error({{"start.x_m", "is missing"}, {"", "the file is empty"}});
    REQUIRE(error.errors().size() == 2);
    CHECK(error.errors()[0].key == "start.x_m");
    CHECK(std::string(error.what()) == "start.x_m: is missing\nthe file is empty");
    // It is caught as a runtime error.
    CHECK_THROWS_AS(throw InputError(std::vector<downwash::KeyError>{{"goal", "is out of reach"}}), std::runtime_error);
}
