#pragma once

// The arithmetic of every law that flights are compiled for.

#include "downwash/controllers/aided_control.hpp"
#include "downwash/controllers/cascaded_pid_control.hpp"
#include "downwash/controllers/control_law.hpp"
#include "downwash/controllers/model_inversion_control.hpp"
