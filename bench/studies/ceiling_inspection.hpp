#pragma once

#include <array>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/studies/ceiling_flight.hpp"

// An inspection by contact: a quadrotor touches a ceiling at several points, one after the other (thesis 4.7.5).

namespace downwash::studies {

/// The mission: under each point climb to the ceiling, press against it, come down, and travel to the next, with rests.
struct CeilingInspection {
    CeilingVehicle vehicle;
    bool knows_ceiling = true;  ///< the laws divide by K_c of the height that they see; otherwise by 1
    double attitude_gain_1_s =
        20;  ///< k and k' of roll and pitch. **Choice**: stiff enough against a ceiling that is near
    std::vector<std::array<double, 2>> points_m = {{0, 0}, {1, 0}, {1, 1}, {2, 1}};  ///< x and y of the contacts
    double travel_m = -0.4;       ///< height of the frame between contacts, below the ceiling: negative
    double press_m = 0.02;        ///< how far above the ceiling the reference goes
    double speed_m_s = 0.3;       ///< speed of the reference along every leg
    double contact_s = 6;         ///< from the reference's arrival at the ceiling to its leaving
    double rest_s = 3;            ///< before each climb and after each descent
    double sample_s = 0;          ///< between two measurements of the position; 0: every tick
    double position_noise_m = 0;  ///< standard deviation of each coordinate
};

/// What comes of it, at 100 Hz. Heights are those of the frame below the ceiling; angles in degrees.
struct CeilingInspectionFlight {
    std::vector<double> time_s, x_m, y_m, height_m, reference_x_m, reference_y_m, reference_height_m, ceiling_factor,
        roll_deg, pitch_deg, yaw_deg, demanded_roll_deg, demanded_pitch_deg;
    int contacts_held =
        0;  ///< points at which the frame is at the ceiling, to 1 mm, all through the last half of contact_s
    bool always_leaves = true;  ///< whether it came down from every point before the next leg began
    double delay_s = 0;         ///< the longest, over points, from the reference to the frame 5 cm below the ceiling
    double below_travel_m = 0;  ///< how far the frame falls below travel_m at most
    double max_aside_m = 0;     ///< greatest horizontal distance from the reference while it rests
    double max_tilt_deg = 0;    ///< greatest angle between the vehicle's axis and the vertical
};

/// Flies the mission under all Lyapunov laws: altitude, position, attitude. @pre at least one point
[[nodiscard]] DOWNWASH_EXPORT CeilingInspectionFlight fly(const CeilingInspection& mission);

}  // namespace downwash::studies
