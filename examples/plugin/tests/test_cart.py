"""The cart keeps the contract that every driver keeps."""

from __future__ import annotations

from fieldhand_example.cart import CartDriver, CartFaults

import fieldhand as fh
from fieldhand.clock import Clock, SimulatedClock
from fieldhand.execution.drivers.protocol import Driver
from fieldhand.site.model import Site
from fieldhand.testing.driver_contract import DriverContract


class TestCart(DriverContract):
    """The cart in each situation of the contract."""

    def make(self, faults: CartFaults = CartFaults()) -> tuple[Driver, Clock, Site]:  # noqa: B008  frozen
        site, clock = fh.Site.demo(), SimulatedClock()
        return (
            CartDriver(site=site, robot=fh.Robot.load("cart"), clock=clock, at=site.start.xy, faults=faults),
            clock,
            site,
        )

    def make_blocked(self) -> tuple[Driver, Clock, Site]:
        return self.make(CartFaults(obstacle_m=5.0))

    def make_lost(self) -> tuple[Driver, Clock, Site]:
        return self.make(CartFaults(lost_s=(4.0, 60.0)))

    def make_broken(self) -> tuple[Driver, Clock, Site]:
        return self.make(CartFaults(broken=frozenset({"read_co2"})))
