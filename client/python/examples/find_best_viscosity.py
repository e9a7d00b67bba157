# %% Finds the viscosity at which an oil loses least over a mix of speeds.
# A thin oil shears with less force, but its film is thinner and more load falls on asperities.
# Needs scipy. Each step is one call of the server, which keeps nothing of it.
import numpy as np
from scipy.optimize import minimize_scalar

import tribodyn

client = tribodyn.Client()
oil = client.lubricants.get("paper-fluid-1")
speeds = [40.0, 60.0, 80.0]  # km/h
weights = np.array([0.5, 0.3, 0.2])  # shares of the time
asperity_friction_coefficient = 0.22  # without a friction modifier


def mean_loss_watts(factor: float) -> float:
    """Returns the mean mesh loss power of the oil with its viscosity times a factor."""
    prefactor = factor * oil.vogel_viscosity_prefactor_pascal_seconds
    points = client.evaluate(
        {"speed_kilometres_per_hour": speeds},
        lubricant=oil.name,
        sump_temperature_celsius=90,
        **{
            "lubricant.vogel_viscosity_prefactor_pascal_seconds": prefactor,
            "surface.asperity_friction_coefficient": asperity_friction_coefficient,
        },
    )
    assert (points["status"] == "OK").all(), points["status_message"]
    return float(weights @ np.asarray(points["mesh_loss_power_watts"]))


# %% A bounded search over the logarithm, to one percent
best = minimize_scalar(
    lambda exponent: mean_loss_watts(np.exp(exponent)),
    bounds=np.log([0.2, 10.0]),
    method="bounded",
    options={"xatol": 0.01},
)
factor = float(np.exp(best.x))
print(
    f"least mean loss: {best.fun:.2f} W at {factor:.2f} times the viscosity, after {best.nfev} "
    f"evaluations; {mean_loss_watts(1):.2f} W as it is"
)

# %% The oil as a lubricant, to keep and to compare
name = "thicker-oil" if factor > 1 else "thinner-oil"
client.lubricants.create(
    name,
    oil,
    display_name=f"{oil.display_name}, {factor:.2f} times the viscosity",
    derived_from=oil.name,
    vogel_viscosity_prefactor_pascal_seconds=factor * oil.vogel_viscosity_prefactor_pascal_seconds,
)
