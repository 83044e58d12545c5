"""Sphere pressed into a layer on a rigid base: writes layer_sphere.csv to standard output.

An independent method: the dual integral equations of the axisymmetric contact, turned into a
Fredholm equation of the second kind by Abel's transform (Lebedev & Ufliand 1958), solved by Gauss
quadrature. Unit contact modulus, thickness and radius 50. Needs numpy and scipy.

    p(r) has the zero-order Hankel transform P(k) = int_0^a f(t) cos(kt) dt,
    f(t) + (2/pi) int_0^a f(s) int_0^inf (M(k) - 1) cos(kt) cos(ks) dk ds = (d - t^2/R)/pi,
    force = 2 pi int_0^a f dt,  f(a) = 0.
"""
import numpy as np
from scipy.optimize import brentq

RADIUS = 50.0


def bonded(k, nu):
    c = 3 - 4 * nu
    e = np.exp(-2 * k)
    s = (1 - e * e) / 2
    series = (2 * k) ** 3 / 6 * (1 + k * k / 5 * (1 + 2 * k * k / 21))
    difference = np.where(k < 0.05, e * series, s - 2 * k * e)
    return (difference + (c - 1) * s) / (c * (1 + e * e) / 2 + (2 * k * k + 5 - 12 * nu + 8 * nu * nu) * e)


def frictionless(k, nu):
    e = np.exp(-2 * k)
    return (1 - e) ** 2 / 2 / ((1 - e * e) / 2 + 2 * k * e)


# (M - 1) falls with exp(-2k): 40 is beyond rounding.
nodes, weights = np.polynomial.legendre.leggauss(400)
K, WK = 20 * (nodes + 1), 20 * weights
x, w = np.polynomial.legendre.leggauss(60)


def solve(shortfall, a, indentation):
    t, wt = 0.5 * a * (x + 1), 0.5 * a * w
    cosines = np.cos(np.outer(t, K))
    kernel = (cosines * (shortfall * WK)) @ cosines.T
    f = np.linalg.solve(
        np.eye(len(t)) + 2 / np.pi * kernel * wt, (indentation - t * t / RADIUS) / np.pi
    )
    edge = (indentation - a * a / RADIUS) / np.pi - 2 / np.pi * (
        (np.cos(a * K) * shortfall * WK) @ cosines.T @ (wt * f)
    )
    return edge, 2 * np.pi * wt @ f


print("base,poisson_ratio,indentation,contact_radius,force")
for base, model in (("bonded", bonded), ("frictionless", frictionless)):
    for nu in (0.3, 0.5):
        shortfall = model(K, nu) - 1
        for indentation in (0.002, 0.005, 0.02, 0.08):
            hertz = np.sqrt(RADIUS * indentation)
            a = brentq(lambda a: solve(shortfall, a, indentation)[0], 0.5 * hertz, 2 * hertz, xtol=1e-13)
            force = solve(shortfall, a, indentation)[1]
            print(f"{base},{nu},{indentation},{a:.9g},{force:.9g}")
