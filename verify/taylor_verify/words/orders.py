"""The order of convergence of a quantity in words: the order, the best step, and what stops the errors."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite, log10

from taylor_verify.records.answers import Order, OrderPoint, Stall
from taylor_verify.records.observed_order import CLEAR, local_orders


def order_sentence(order: Order) -> str:
    """Return what is known of an order."""
    return "; ".join(_sentences(order))


def _sentences(order: Order) -> Iterator[str]:
    if all(_is_at_the_floor(point) for point in order.points if point.error is not None):
        yield f"{order.quantity}: no order shows, because the error is near roundoff at every step"
        return
    yield f"{order.quantity}: {_order_words(order)}"
    if order.best_step is not None and order.best_error is not None:
        best = f"best {order.knob} = {order.best_step:g} with {_accuracy(order, order.best_error)}"
        yield f"{best}{_below_the_best(order, order.best_step, order.best_error)}"


def _is_at_the_floor(point: OrderPoint) -> bool:
    return point.error is not None and point.error <= CLEAR * (point.attainable or 0.0)


def _order_words(order: Order) -> str:
    clear = order.clear
    if order.order is not None and order.high is not None and order.largest is not None:
        spread = order.high - order.order
        uncertain = f" ± {spread:.1f}" if spread >= 0.05 else ""
        steps = f"from {order.knob} = {order.largest:g} to {order.smallest:g}"
        # Larger steps may not be asymptotic, or may hide a lower order.
        larger = local_orders([point for point in clear if point.step >= order.largest])
        left_out = ", ".join(f"{local:.1f}" for local in larger)
        left_out = f" ({left_out} at larger steps)" if left_out else ""
        return f"order {order.order:.1f}{uncertain} {steps}{left_out}"
    between = [f"{local:.1f}" for local in local_orders(clear)]
    no_fit = f"no one order fits: from step to step it is {', '.join(between)}"
    if order.suspect is not None and order.suspect_step is not None:
        labelled = next(p.step for p in order.points if p.file == order.suspect)
        return (
            f"{no_fit}; the others agree without {order.suspect}, whose error is that of "
            f"{order.knob} = {order.suspect_step:g} and not of {labelled:g}"
        )
    if len(between) >= 2:
        return no_fit
    if between:
        large, small = clear[0].step, clear[-1].step
        pair = f"between {order.knob} = {large:g} and {small:g}"
        return f"order {between[0]} {pair}, which no third step confirms"
    level = "roundoff" if order.stall is None else "the level at which errors stop falling"
    return f"no order shows, because fewer than two steps have an error well above {level}"


def _accuracy(order: Order, error: float) -> str:
    if order.unit == "rad":
        return f"an error of {error:.1e} rad"
    if not error > 0 or not isfinite(error):
        return "no error"
    return f"{max(0.0, -log10(error)):.1f} digits"


def _below_the_best(order: Order, step: float, error: float) -> str:
    """Return the course of the error at steps smaller than the best one, in words."""
    if order.stall is None or order.stalls_at is None:
        last = order.points[-1]
        falls = "near roundoff" if _is_at_the_floor(last) else "the error still falls"
        return f", the smallest: {falls}" if step == last.step else ""
    place = (
        "below it" if order.stalls_at == step else f"from {order.knob} = {order.stalls_at:g} down"
    )
    if order.stall is Stall.ROUNDOFF:
        return f"; {place} roundoff takes over"
    if order.stall is Stall.DIGITS:
        return f"; {place} the error is that of the printed digits"
    floors = [p.attainable for p in order.points if p.attainable and p.step == step]
    above = f" {error / floors[0]:.0e} times what roundoff leaves" if floors and error else ""
    return (
        f"; {place} the error falls no longer, at{above}: a lower precision inside, or an error that no "
        "step removes"
    )
