# %% Finds the sump temperature at which an oil loses least, if its film stays thick enough.
# A hot oil shears with less force, but its film is thinner and more load falls on asperities.
# Needs scipy.
import numpy as np
from scipy.optimize import minimize_scalar

import tribodyn

client = tribodyn.Client(progress="none")
speeds = [40.0, 80.0, 120.0]  # km/h
weights = np.array([0.5, 0.3, 0.2])  # shares of the time
least_film_ratio = 0.6


def loss_and_film(sump_temperature_celsius: float) -> tuple[float, float]:
    """Returns the mean mesh loss power in watts and the least film ratio."""
    points = client.evaluate(
        {"speed_kilometres_per_hour": speeds},
        lubricant="paper-fluid-1",
        sump_temperature_celsius=sump_temperature_celsius,
    )
    assert (points["status"] == "OK").all(), points["status_message"]
    return (
        float(weights @ np.asarray(points["mesh_loss_power_watts"])),
        float(np.min(points["film_ratio_mean"])),
    )


def penalised_loss(sump_temperature_celsius: float) -> float:
    loss, film = loss_and_film(sump_temperature_celsius)
    return loss * (1 + 100 * max(0.0, least_film_ratio - film))


# %% A bounded search to half a degree
best = minimize_scalar(penalised_loss, bounds=(20, 140), method="bounded", options={"xatol": 0.5})
loss, film = loss_and_film(best.x)
print(
    f"least mean loss: {loss:.1f} W at {best.x:.1f} C, film ratio {film:.3f}, "
    f"after {best.nfev} evaluations; {loss_and_film(40)[0]:.1f} W at 40 C"
)
