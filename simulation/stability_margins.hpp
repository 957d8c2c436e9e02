#pragma once

namespace downwash {

/// How far a loop is from instability.
struct LoopMargins {
    double gain_margin_db = 0;    ///< least change of the gain, up or down, that makes it unstable; infinite: none
    double phase_margin_rad = 0;  ///< least lag, or lead, that makes it unstable; infinite: the gain is never 1
    double crossover_rad_s = 0;   ///< greatest frequency at which the gain is 1; 0: none
    double delay_margin_s = 0;    ///< least further delay that makes it unstable by its phase margins
    double bandwidth_rad_s = 0;   ///< greatest frequency at which the closed loop's answer is 1 / sqrt 2; 0: none
};

}  // namespace downwash
