#include <catch2/catch.hpp>

#include "program.hpp"

using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;

namespace {

const std::string robots = std::string(DOWNWASH_PROBLEMS) + "/robots/";

constexpr const char* stand =
    "throttle;Thrust (gf);Torque (N·m);RPM;Power (W)\n"
    "1200;100,0;0,0157;3000;7\n1600;400,0;0,0628;6000;50\n2000;900,0;0,1412;9000;165\n"
    "1200;102,0;0,0160;3000;7\n1600;396,0;0,0622;6000;49\n2000;909,0;0,1426;9000;168\n";

}  // namespace

TEST_CASE("robot show prints what a robot in space amounts to, and writes its page") {
    const Workspace work;
    const auto shown = work.json("robot show", robots + "hexa370_arm3.yaml");
    CHECK(shown.at("robot") == "hexa370_arm3");
    CHECK(shown.at("is_planar") == false);
    CHECK(shown.at("rotors").size() == 6);
    CHECK(shown.at("links").size() == 3);
    double carried_n = 0;
    for (const auto& rotor : shown.at("rotors")) {
        carried_n += rotor.at("hover_thrust_n").get<double>();
    }
    CHECK(carried_n == Approx(shown.at("mass_kg").get<double>() * 9.80665).epsilon(1e-9));
    CHECK_THAT(work.succeed("robot show", robots + "hexa370_arm3.yaml").out,
               Contains("hexa370_arm3, in space") && Contains("multirotor ") && Contains("link 3") &&
                   Contains("turns left") && Contains("rotor 6"));
    if (has_pages) {
        work.succeed("robot show", robots + "hexa370_arm3.yaml", "-o robot.html");
        CHECK_THAT(work.text("robot.html"), Contains("downwash/robot-report/v1"));
    }
    check_rejected(work.run("robot show", robots + "hexa370_arm3.yaml", "-o robot.pdf"),
                   "--out 'robot.pdf': expected a name that ends in .html");
    CHECK(work.run("robot show missing.yaml").code == 2);
}

TEST_CASE("robot show takes a robot in a vertical plane, which does not say how its rotors turn") {
    const Workspace work;
    const auto shown = work.json("robot show", robots + "ars_lrm.yaml");
    CHECK(shown.at("is_planar") == true);
    CHECK(shown.at("rotors")[0].at("spin").is_null());
    CHECK(shown.at("links").size() == 1);
    CHECK_THAT(work.succeed("robot show", robots + "ars_lrm.yaml").out,
               Contains("in a vertical plane") && Contains("arm ") && !Contains("turns"));
}

TEST_CASE("robot thrust says which columns it took, and writes the keys of a rotor") {
    const Workspace work;
    write_file(work.in_run("stand.csv"), stand);
    const Result result = work.succeed("robot thrust stand.csv");
    CHECK_THAT(result.out, Contains("stand.csv: 6 rows, 6 steady measurements") &&
                               Contains("thrust 'Thrust (gf)' in gf") && Contains("speed 'RPM' in RPM") &&
                               Contains("rotors:\n  min_thrust_n: 0.990"));
    CHECK_THAT(result.err, Contains("the lag is not known"));
    work.succeed("robot thrust stand.csv -o rotor.yaml");
    CHECK_THAT(work.text("rotor.yaml"), Contains("# From stand.csv") && Contains("\n  torque_ratio_m: 0.016") &&
                                            Contains("rotor_thrust_scale: {sd: 0.0"));
    const auto document = work.json("robot thrust stand.csv --radius-m 0.127");
    CHECK(document.at("max_thrust_n").get<double>() == Approx(904.5 * 0.00980665));
    CHECK(document.at("c_t").get<double>() > 0);
    CHECK(document.at("lag").is_null());
    CHECK(document.at("files")[0].at("columns").size() == 5);
    check_rejected(work.run("robot thrust stand.csv --unit thrust"), "--unit is 'thrust': expected QUANTITY=UNIT");
    write_file(work.in_run("bad.csv"), "throttle,Thrust (gf)\n1,2\n2,much\n");
    check_rejected(work.run("robot thrust bad.csv"), "bad.csv:3:3: ");
}
