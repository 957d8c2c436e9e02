#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "downwash/effects/measurements.hpp"

using namespace downwash;

TEST_CASE("Measurements keep all their columns and can be chosen by them") {
    const Measurements all = read_measurements(DOWNWASH_MEASUREMENTS);
    CHECK(all.points.size() == 45);
    CHECK(all.index("pwm_level") == 3);
    CHECK_FALSE(all.index("sigma"));
    CHECK(all.entries("source") == std::vector<std::string>{"jirs2024", "hydrus15_isolated"});
    CHECK(all.entries("surface") == std::vector<std::string>{"ceiling", "ground"});
    CHECK(all.entries("wind").empty());
    const Measurements chosen = all.with("pwm_level", "3").with("surface", "ground");
    REQUIRE(chosen.points.size() == 4);
    CHECK(chosen.points[0].z_over_r == 0.328);
    CHECK(chosen.points[0].thrust_ratio == 1.296);
    CHECK(chosen.points[0].line == 23);
    CHECK(all.with("wind", "").points.empty());
}

TEST_CASE("Measurements of spreadsheets and test stands are those of plain text") {
    const auto values = [](const std::string& text) {
        std::vector<double> found;
        for (const Measurement& point : parse_measurements(text, "m.csv").points) {
            found.push_back(point.z_over_r);
            found.push_back(point.thrust_ratio);
        }
        return found;
    };
    const std::vector<double> expected{0.5, 1.21, 1, 1.058};
    CHECK(values("z_over_r,thrust_ratio\r\n\"0,5\",\"1,21\"\r\n\"1,0\",\"1,058\"\r\n") == expected);
    CHECK(values("sep=;\r\nz_over_r;thrust_ratio\r\n0,5;1,21\r\n1,0;1,058\r\n") == expected);
    CHECK(values("z_over_r\tthrust_ratio\n0.5\t1.21\n1\t1.058\n") == expected);
    CHECK(parse_measurements("Z_over_R,Thrust_Ratio,Surface\n1,1.1,ground\n", "m.csv").entries("surface") ==
          std::vector<std::string>{"ground"});
    CHECK(values("Z_over_R,Thrust_Ratio,\n0.5,1.21,\n1,1.058,\n") == expected);
    CHECK(values(",z_over_r,thrust_ratio\n0,0.5,1.21\n1,1.0,1.058\n") == expected);
}

TEST_CASE("Measurements that cannot be used are errors with their line") {
    const auto error = [](const std::string& text) {
        return test::error_of([&] { return parse_measurements(text, "m.csv"); });
    };
    CHECK(error("z_over_r,ratio\n1,2\n") ==
          "m.csv:1: has no column thrust_ratio in 'z_over_r, ratio': expected z_over_r and thrust_ratio");
    CHECK(error("#\nz_over_r,thrust_ratio\n") == "m.csv:2: no rows follow: expected measurements");
    CHECK(error("z_over_r,thrust_ratio\n0,1\n1,-1\nnan,1\n") ==
          "m.csv:2:1: z_over_r is '0': expected a number from 1e-06 to 1000\n"
          "m.csv:3:3: thrust_ratio is '-1': expected a number from 0 to 100\n"
          "m.csv:4:1: z_over_r is 'nan': expected a number from 1e-06 to 1000");
    CHECK(error("z_over_r,thrust_ratio,sigma\n1,1,\n1,1,0.1\n1,1,0\n") ==
          "m.csv:4:5: sigma is '0': expected a number from 1e-09 to 100");
    CHECK(error("surface,z_over_r,thrust_ratio\nground,1,1\nBoden,1,1\n,2,1\ncieling,1,1\n") ==
          "m.csv:3:1: has the surface 'Boden'; expected ground or ceiling\n"
          "m.csv:5:1: has the surface 'cieling'; expected ground or ceiling; did you mean 'ceiling'?");
    CHECK_THROWS_WITH(read_measurements("/nowhere.csv"), "/nowhere.csv cannot be read: there is no such file");
}
