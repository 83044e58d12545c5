"""Rate, viscoelasticity, friction, conductance and menisci of a contact."""

from __future__ import annotations

from ..quantities import Floats, Quantities
from ._evaluate import one, several


def power_law(
    work_of_adhesion: Quantities,
    speed: Quantities,
    reference_speed: Quantities,
    exponent: Quantities,
) -> Floats:
    """Work of adhesion of a receding edge of a speed, J/m^2. Gent & Schultz 1972; Maugis & Barquins 1978.

    Parameters
    ----------
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    speed : number, text or array
        Speed of the receding edge, m/s.
    reference_speed : number, text or array
        Speed that the law refers to, m/s.
    exponent : number, text or array
        Power of the speed.
    """
    return one("rate.power_law", locals())


def logarithmic_law(
    work_of_adhesion: Quantities,
    slope: Quantities,
    speed: Quantities,
    reference_speed: Quantities,
) -> Floats:
    """Work of adhesion that grows with the logarithm of the speed, J/m^2.

    Parameters
    ----------
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    slope : number, text or array
        Growth with the logarithm of the speed, J/m^2.
    speed : number, text or array
        Speed of the receding edge, m/s.
    reference_speed : number, text or array
        Speed that the law refers to, m/s.
    """
    return one("rate.logarithmic_law", locals())


def relaxation(
    relaxed_modulus: Quantities,
    branch_modulus: Quantities,
    relaxation_time: Quantities,
    time: Quantities,
) -> Floats:
    """Relaxation modulus of a standard linear solid at a time after a step of strain, Pa.

    Parameters
    ----------
    relaxed_modulus : number, text or array
        Modulus after a long time, Pa.
    branch_modulus : number, text or array
        Modulus that relaxes, Pa.
    relaxation_time : number, text or array
        Relaxation time, s.
    time : number, text or array
        Time since the step, s.
    """
    return one("viscoelastic.relaxation", locals())


def creep(
    relaxed_modulus: Quantities,
    branch_modulus: Quantities,
    relaxation_time: Quantities,
    time: Quantities,
) -> Floats:
    """Creep compliance at a time after a step of stress, 1/Pa.

    Parameters
    ----------
    relaxed_modulus : number, text or array
        Modulus after a long time, Pa.
    branch_modulus : number, text or array
        Modulus that relaxes, Pa.
    relaxation_time : number, text or array
        Relaxation time, s.
    time : number, text or array
        Time since the step, s.
    """
    return one("viscoelastic.creep", locals())


def creeping_contact_radius(
    relaxed_modulus: Quantities,
    branch_modulus: Quantities,
    relaxation_time: Quantities,
    radius: Quantities,
    force: Quantities,
    time: Quantities,
) -> Floats:
    """Contact radius of a sphere at a time after a step to a force, m. Lee & Radok 1960.

    Parameters
    ----------
    relaxed_modulus : number, text or array
        Modulus after a long time, Pa.
    branch_modulus : number, text or array
        Modulus that relaxes, Pa.
    relaxation_time : number, text or array
        Relaxation time, s.
    radius : number, text or array
        Radius of the sphere, m.
    force : number, text or array
        Force, N, positive in compression.
    time : number, text or array
        Time since the step, s.
    """
    return one("viscoelastic.contact_radius", locals())


def jkr_friction(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    shear_strength: Quantities,
    force: Quantities,
) -> Floats:
    """Friction force of a JKR sphere under a normal force, N. Homola et al. 1990.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    shear_strength : number, text or array
        Shear strength, Pa.
    force : number, text or array
        Force, N, positive in compression.
    """
    return one("friction.jkr_force", locals())


def conductance_from_stiffness(conductivity: Quantities, contact_modulus: Quantities, stiffness: Quantities) -> Floats:
    """Conductance of a contact from its stiffness, W/K. Barber 2003.

    Parameters
    ----------
    conductivity : number, text or array
        Conductivity of the pair, W/(m K), or S/m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    stiffness : number, text or array
        Slope of force against approach, N/m.
    """
    return one("conductance.from_stiffness", locals())


def conductance_of_circle(conductivity: Quantities, radius: Quantities) -> Floats:
    """Conductance of one circular spot, W/K.

    Parameters
    ----------
    conductivity : number, text or array
        Conductivity of the pair, W/(m K), or S/m.
    radius : number, text or array
        Radius of the sphere, m.
    """
    return one("conductance.circle", locals())


def meniscus(
    surface_tension: Quantities,
    molar_volume: Quantities,
    temperature: Quantities,
    relative_humidity: Quantities,
    contact_angle: Quantities,
) -> tuple[Floats, Floats, Floats, Floats]:
    """The attraction of a liquid bridge as a law of constant tension. Israelachvili 2011.

    Parameters
    ----------
    surface_tension : number, text or array
        Surface tension of the liquid, N/m.
    molar_volume : number, text or array
        Molar volume of the liquid, m^3/mol.
    temperature : number, text or array
        Temperature, K.
    relative_humidity : number, text or array
        Relative humidity, 0 to 1.
    contact_angle : number, text or array
        Contact angle, rad.

    Returns
    -------
    work_of_adhesion : float or array
        Work of adhesion, J/m^2.
    range : float or array
        Range, m.
    peak_tension : float or array
        Suction in the liquid, Pa.
    kelvin_radius : float or array
        Kelvin radius, m.
    """
    work_of_adhesion, range, peak_tension, kelvin_radius = several("capillary.meniscus", locals())
    return work_of_adhesion, range, peak_tension, kelvin_radius


def pull_off_at_speed(
    radius: Quantities,
    contact_modulus: Quantities,
    work_of_adhesion: Quantities,
    speed: Quantities,
    reference_speed: Quantities,
    exponent: Quantities,
) -> Floats:
    """Force at pull-off of a JKR sphere that is pulled from zero load at a speed, N, negative: `power_law` at its edge.

    Parameters
    ----------
    radius : number, text or array
        Radius of the sphere, m.
    contact_modulus : number, text or array
        E* of the pair, Pa.
    work_of_adhesion : number, text or array
        Work of adhesion, J/m^2.
    speed : number, text or array
        Speed at which the sphere is pulled, m/s.
    reference_speed : number, text or array
        Speed that the law refers to, m/s.
    exponent : number, text or array
        Power of the speed, 0.1 to 2.
    """
    return one("rate.pull_off", locals())


def creeping_pressure(
    relaxed_modulus: Quantities,
    branch_modulus: Quantities,
    relaxation_time: Quantities,
    radius: Quantities,
    force: Quantities,
    time: Quantities,
    r: Quantities,
) -> Floats:
    """Pressure at a distance from the axis of a sphere at a time after a step to a force, Pa. Lee & Radok 1960.

    Parameters
    ----------
    relaxed_modulus : number, text or array
        Modulus after a long time, Pa.
    branch_modulus : number, text or array
        Modulus that relaxes, Pa.
    relaxation_time : number, text or array
        Relaxation time, s.
    radius : number, text or array
        Radius of the sphere, m.
    force : number, text or array
        Force, N, positive in compression.
    time : number, text or array
        Time since the step, s.
    r : number, text or array
        Distance from the axis, m.
    """
    return one("viscoelastic.pressure", locals())


def combined_conductivity(
    conductivity: Quantities,
    counter_conductivity: Quantities,
) -> Floats:
    """Conductivity of a pair, 2 k1 k2/(k1 + k2), W/(m K), or S/m.

    Parameters
    ----------
    conductivity : number, text or array
        Conductivity of the solid, W/(m K), or S/m.
    counter_conductivity : number, text or array
        Conductivity of the counter-face, in the same unit.
    """
    return one("conductance.combined", locals())


def meniscus_force(
    surface_tension: Quantities,
    molar_volume: Quantities,
    temperature: Quantities,
    relative_humidity: Quantities,
    contact_angle: Quantities,
    radius: Quantities,
    gap: Quantities,
) -> Floats:
    """Force of a liquid bridge on a rigid sphere, N, negative.

    Parameters
    ----------
    surface_tension : number, text or array
        Surface tension of the liquid, N/m.
    molar_volume : number, text or array
        Molar volume of the liquid, m^3/mol.
    temperature : number, text or array
        Temperature, K.
    relative_humidity : number, text or array
        Relative humidity, 0 to 1.
    contact_angle : number, text or array
        Contact angle, rad.
    radius : number, text or array
        Radius of the sphere, m.
    gap : number, text or array
        Least gap, m.
    """
    return one("capillary.rigid_force", locals())
