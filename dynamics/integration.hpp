#pragma once

#include "downwash/dynamics/planar_contact.hpp"
#include "downwash/dynamics/plant_model.hpp"
#include "downwash/dynamics/surroundings.hpp"

// How the plant moves over one control tick: settings. flight_step.hpp and contact_step.hpp have the arithmetic.

namespace downwash::dynamics {

/// One Runge-Kutta step; for planning.
struct OneStep {
    /// The state after `dt_s`; see flight_step().
    template <class T, class P, Surroundings<T> Around>
    PlantState<T> operator()(const BasicPlantModel<P>& model, const PlantState<T>& state, const Motion<T>& motion,
                             const PlantCommand<T>& command, T dt_s, const Around& around) const;
};

/// One Runge-Kutta step under a command to which something is added between controller and plant.
struct DisturbedStep {
    PlantCommand<double> added;

    /// The state after `dt_s`; see flight_step().
    template <Surroundings<double> Around>
    PlantState<double> operator()(const PlantModel& model, const PlantState<double>& state,
                                  const Motion<double>& motion, const PlantCommand<double>& command, double dt_s,
                                  const Around& around) const;
};

/// As many steps as the tick needs; for flights that are reported. Where a rotor disc passes the edge of an obstacle K
/// is not smooth, and one step of 10 ms can be wrong by 2e-5 in a rate. A step is halved until both halves agree with
/// the whole.
struct RefinedStep {
    double tolerance = 1e-7;  ///< allowed error of every coordinate and rate, SI units
    int max_halvings = 8;

    /// The state after `dt_s`; see flight_step().
    template <Surroundings<double> Around>
    PlantState<double> operator()(const PlantModel& model, const PlantState<double>& state,
                                  const Motion<double>& motion, const PlantCommand<double>& command, double dt_s,
                                  const Around& around) const;

 private:
    template <Surroundings<double> Around>
    PlantState<double> refined(const PlantModel& model, const PlantState<double>& state,
                               const PlantCommand<double>& command, double dt_s, const Around& around,
                               const PlantState<double>& whole, int halvings) const;
    [[nodiscard]] bool agree(const PlantState<double>& a, const PlantState<double>& b) const;
};

/// A tick beside a surface, in as many Runge-Kutta steps as contact needs: one where nothing can touch.
struct ContactStep {
    const PlanarContact& contact;  ///< its points are those of the model without `center_of_mass`
    PlanePoint<double> center_of_mass_m{
        0, 0};  ///< centre of mass of the plant, from the point to which contact points refer, in the body frame
    ContactTickRecord& record;  ///< record of the last tick
    double step_share = 1;      ///< share of the step that is taken otherwise; for tests

    /// The state after `dt_s`; see flight_step().
    template <Surroundings<double> Around>
    PlantState<double> operator()(const PlantModel& model, const PlantState<double>& state,
                                  const Motion<double>& motion, const PlantCommand<double>& command, double dt_s,
                                  const Around& around) const;
};

}  // namespace downwash::dynamics
