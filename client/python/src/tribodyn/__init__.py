"""Client of tribodynd, the server for tribodynamic simulation of hypoid axles.

    import tribodyn
    client = tribodyn.Client()
    curves = client.compare(["paper-fluid-1", "paper-fluid-2"], sump_temperature_celsius=90)

``tribodyn.aio.Client`` has the same methods as coroutines. ``tribodyn.v1`` holds the messages.
"""

from tribodyn._candidates import Design, Lubricants, Rig
from tribodyn._frames import Table
from tribodyn._profiles import Profile
from tribodyn._simulation_requests import Options
from tribodyn.client import Campaign, Client, Resources
from tribodyn.errors import TribodynError, Violation
from tribodyn.units import Quantity, QuantityError, quantity

__all__ = [
    "Campaign",
    "Client",
    "Design",
    "Lubricants",
    "Options",
    "Profile",
    "Quantity",
    "QuantityError",
    "Resources",
    "Rig",
    "Table",
    "TribodynError",
    "Violation",
    "quantity",
]
