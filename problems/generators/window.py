"""A window that is too low for an upright arm: fold it, pass, and raise it again."""

from .problem_text import Problem, goal, one


def problems():
    about = [
        "The window of dynobench's scene `window` in space, flown with an arm.",
        "The window is 1.8 m wide and 1.0 m high, in a wall of 0.3 m. With its arm upright the vehicle is 1.3 m high, so "
        "the arm has to fold on the way; it stands upright again at the goal.",
    ]
    description = "Fly through a window too low for an upright arm, upright before and after."
    problem = Problem("window", about, description, "hexa960_arm2", "window.py")
    problem.source(
        "dynobench (Ortiz-Haro et al., https://github.com/quimortiz/dynobench), envs/quadrotor_v0/window: wall, window, "
        "start, goal and bounds of the centre. Ours: the wall goes on behind the bounds, so that no part of the vehicle "
        "gets around it."
    )
    y = 2.85, 3.15
    problem.between("right_of_window", (3, y[0], -0.5), (7, y[1], 5))
    problem.between("left_of_window", (-1, y[0], -0.5), (1.2, y[1], 5))
    problem.between("above_window", (1.2, y[0], 2.4), (3, y[1], 5))
    problem.between("below_window", (1.2, y[0], -0.5), (3, y[1], 1.4))
    problem.bounds = (1, 0.5, 1), (5, 5.5, 3)
    problem.start = {"x_m": 4, "y_m": 1, "z_m": 2, "yaw_deg": 90, "joints_deg": (0, 0)}
    end = {"x_m": 4, "y_m": 5, "z_m": 2, "joints_deg": (0, 0), "tolerance_m": 0.1, "tolerance_deg": 5}
    problem.goal = one(goal("configuration", end))
    return [problem]
