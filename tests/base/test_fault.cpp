#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "downwash/base/fault.hpp"

using downwash::InputError;

TEST_CASE("An input error carries its faults and shows each on a line of its own") {
    const InputError error({{"start.x_m", "is missing"}, {"", "the file is empty"}});
    REQUIRE(error.faults().size() == 2);
    CHECK(error.faults()[0].key == "start.x_m");
    CHECK(std::string(error.what()) == "start.x_m: is missing\nthe file is empty");
}

TEST_CASE("An input error is caught as a runtime error") {
    CHECK_THROWS_AS(throw InputError(std::vector<downwash::Fault>{{"goal", "is out of reach"}}), std::runtime_error);
}
