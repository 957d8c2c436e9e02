#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include <unistd.h>

#include "downwash/problems/problem_reader.hpp"

namespace downwash::test {

/// A sound problem; the tests of malformed files break it in one place each.
inline constexpr std::string_view good_problem = R"(schema: downwash/problem/v1
name: test
robot: robot.yaml
environment:
  bounds: {x_m: [-6, 6], z_m: [0.5, 5]}
  obstacles:
    - {name: ground, box: {size_m: [30, 20, 1], center_m: [0, 0, -0.5]}}
    - {name: pole, cylinder: {radius_m: 0.2, length_m: 5, center_m: [4, 3, 2.5]}}
aero:
  ground: {model: cheeseman-bennett}
  ceiling: {model: sanchez-cuevas, k1: 6.9}
start: {x_m: -4, z_m: 2, arm_deg: 90}
goal:
  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}
  hold_s: 5
planner: {variant: mp-arm-ada, algorithm: rrt-star, objective: energy, seed: 1}
)";

inline constexpr std::string_view good_robot = R"(schema: downwash/robot/v1
name: tester
multirotor:
  mass_kg: 4.5
  pitch_inertia_kg_m2: 0.2
  body:
    - box: {size_m: [1, 1, 0.2], center_m: [0, 0, 0]}
rotors:
  radius_m: 0.19
  positions_m: [[0.3, 0.3, 0], [0.3, -0.3, 0], [-0.3, 0.3, 0], [-0.3, -0.3, 0]]
  max_thrust_n: 28
  power_coefficient_w_n1p5: 3.1
arm: {length_m: 1.2, mass_kg: 0.45, center_of_mass_m: 0.7, inertia_kg_m2: 0.06, radius_m: 0.03, max_torque_nm: 12}
controller:
  position: {kp: 2, kd: 2.6}
  attitude: {kp: 8, rate_kp: 20}
  arm: {kp: 30, kd: 11}
  max_tilt_deg: 35
)";

/// A folder for one test, removed with everything in it.
class TestFolder {
 public:
    TestFolder() : path_(std::filesystem::temp_directory_path() / ("downwash-test-" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    void write(std::string_view name, std::string_view text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
    }

    /// A problem written beside a robot, and read.
    [[nodiscard]] Problem read(std::string_view problem = good_problem, std::string_view robot = good_robot) const {
        write("problem.yaml", problem);
        write("robot.yaml", robot);
        return read_problem(path_ / "problem.yaml");
    }

    /// The errors that an action ends with, without the folder's own path; "sound" when there is none.
    template <class Action>
    [[nodiscard]] std::string errors_in(const Action& action) const {
        std::string said;
        try {
            static_cast<void>(action());
            return "sound";
        } catch (const ProblemFileError& error) {
            said = error.what();
        }
        const std::string prefix = path_.string() + "/";
        for (std::size_t at = said.find(prefix); at != std::string::npos; at = said.find(prefix)) {
            said.erase(at, prefix.size());
        }
        return said;
    }
    /// Those of a file.
    [[nodiscard]] std::string errors_of(std::string_view name) const {
        return errors_in([&] { return read_problem(path_ / name); });
    }
    /// Those of a problem beside a robot.
    [[nodiscard]] std::string errors_of(std::string_view problem, std::string_view robot) const {
        return errors_in([&] { return read(problem, robot); });
    }

 private:
    std::filesystem::path path_;
};

/// A text with its only occurrence of `from` replaced.
inline std::string edited(std::string_view text, std::string_view from, std::string_view to) {
    std::string out(text);
    const std::size_t at = out.find(from);
    REQUIRE(at != std::string::npos);
    REQUIRE(out.find(from, at + 1) == std::string::npos);
    return out.replace(at, from.size(), to);
}

}  // namespace downwash::test
