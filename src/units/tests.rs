use super::Dimension::*;
use super::*;

#[test]
fn shares_are_numbers_or_per_cent() {
    for text in ["0.1", "10%", " 10 % ", "1e-1"] {
        assert_eq!(parse_share(text), Ok(0.1), "{text}");
    }
    for text in ["1.1", "-1%", "101 %", "nan", "%", "0,1", "1 um"] {
        let refused = Err(UnitError::NoShare { text: quoted(text) });
        assert_eq!(parse_share(text), refused);
    }
}

#[test]
fn quantities_are_the_nearest_double() {
    for (text, dimension, value) in [
        ("25 um", Length, 25e-6),
        ("25um", Length, 25e-6),
        ("25 µm", Length, 25e-6),
        ("25 μm", Length, 25e-6),
        ("  2.5e1  um ", Length, 25e-6),
        ("+.5 nm", Length, 0.5e-9),
        ("5. m", Length, 5.0),
        ("-1.5 fm", Length, -1.5e-15),
        ("4.1 zJ", Energy, 4.1e-21),
        ("2 aN", Force, 2e-18),
        ("1 mm", Length, 1e-3),
        ("1 km", Length, 1e3),
        ("1.33 TPa", Pressure, 1.33e12),
        ("10 MPa", Pressure, 1e7),
        ("-3 GPa", Pressure, -3e9),
        ("3 pPa", Pressure, 3e-12),
        ("20 nN", Force, 20e-9),
        ("7 mN", Force, 7e-3),
        ("0.3 fJ", Energy, 0.3e-15),
        ("0.2 J/m^2", EnergyPerArea, 0.2),
        ("0.2J/m²", EnergyPerArea, 0.2),
        ("50 mJ / m^2", EnergyPerArea, 0.05),
        ("50 mN/m", EnergyPerArea, 0.05),
        ("0.2 N/m", ForcePerLength, 0.2),
        ("0.2 J/m^2", ForcePerLength, 0.2),
        ("10 ms", Time, 0.01),
        ("1.5 min", Time, 90.0),
        ("5 kHz", Frequency, 5e3),
        ("298.15 K", Temperature, 298.15),
        ("18e-6 m^3/mol", MolarVolume, 18e-6),
        ("18e-6 m³/mol", MolarVolume, 18e-6),
        ("18 cm^3/mol", MolarVolume, 18e-6),
        ("18 cm³ / mol", MolarVolume, 18e-6),
        ("3 um/s", Speed, 3e-6),
        ("3 m/s", Speed, 3.0),
        ("3 mW/(m K)", Conductivity, 3e-3),
        ("3 W/m/K", Conductivity, 3.0),
        ("3e-6 mm^3/(N m)", SpecificWear, 3e-15),
        ("0.3mm³ / (N m)", SpecificWear, 3e-10),
        ("3e-15 m^3/(N m)", SpecificWear, 3e-15),
        ("3e-15 1/Pa", SpecificWear, 3e-15),
        ("3 mPa s", Viscosity, 3e-3),
        ("0.1 1/um", PerLength, 1e5),
        ("9e3/m", PerLength, 9e3),
        ("10 1/um^2", PerArea, 1e13),
        ("2 / mm²", PerArea, 2e6),
        ("0.5", Dimensionless, 0.5),
        ("180 deg", Angle, std::f64::consts::PI),
        ("1.5 rad", Angle, 1.5),
        ("1e-99999999999 m", Length, 0.0),
    ] {
        assert_eq!(parse_quantity(text, dimension), Ok(value), "{text}");
    }
}

#[test]
fn wrong_units_say_which_was_expected() {
    for (text, dimension, message) in [
        (
            "25",
            Length,
            "\"25\" has no unit; give a length in m, such as \"25 um\", or a bare number in m",
        ),
        (
            "25 nN",
            Length,
            "\"nN\" is a force in N; give a length in m, such as \"25 um\"",
        ),
        (
            "25 furlong",
            Length,
            "\"furlong\" is not a unit that is known here; give a length in m",
        ),
        ("25 Km", Length, "\"Km\" is not a unit"),
        ("25 m m", Length, "\"m m\" is not a unit"),
        ("25 mmin", Time, "\"mmin\" is not a unit"),
        ("25 mK", Temperature, "\"mK\" is not a unit"),
        ("25 um^2", Length, "\"um^2\" is not a unit"),
        (
            "2,5 um",
            Length,
            "\"2,5 um\" has a decimal comma; write a point",
        ),
        ("wide", Length, "\"wide\" does not begin with a number"),
        ("", Length, "\"\" does not begin with a number"),
        ("inf m", Length, "\"inf m\" does not begin with a number"),
        ("nan m", Length, "\"nan m\" does not begin with a number"),
        ("- 5 m", Length, "\"- 5 m\" does not begin with a number"),
        (". m", Length, "\". m\" does not begin with a number"),
        ("1e999 m", Length, "\"1e999 m\" is too large"),
        ("1e99999999999 m", Length, "is too large"),
        ("5e m", Length, "\"e m\" is not a unit"),
        (
            "5 J",
            EnergyPerArea,
            "\"J\" is an energy in J; give an energy per area in J/m^2 or N/m",
        ),
        (
            "5 1/um",
            PerArea,
            "\"1/um\" is a reciprocal length in 1/m; give a count per area in 1/m^2",
        ),
        ("5 1/s", PerLength, "\"1/s\" is not a unit"),
        (
            "5 Pa",
            Dimensionless,
            "\"Pa\" is a pressure in Pa; give a number without a unit",
        ),
        (
            "30",
            Angle,
            "\"30\" has no unit; give an angle in deg or rad, such as \"70 deg\", or a bare number in degrees",
        ),
    ] {
        let error = parse_quantity(text, dimension).expect_err(text).to_string();
        assert!(error.contains(message), "{text}: {error}");
    }
}

#[test]
fn units_without_numbers_are_parsed() {
    assert_eq!(unit_factor("nN", Force), Ok(1e-9));
    assert_eq!(unit_factor(" µm ", Length), Ok(1e-6));
    assert_eq!(unit_factor("min", Time), Ok(60.0));
    assert!(unit_factor("", Length).is_err());
    assert!(unit_factor("nm", Force).is_err());
}

#[test]
fn bare_angles_are_degrees() {
    assert_eq!(angle_from_number(180.0), std::f64::consts::PI);
    assert_eq!(parse_quantity("1 rad", Angle), Ok(1.0));
    assert_eq!(
        parse_quantity("90°", Angle),
        parse_quantity("90 deg", Angle)
    );
    assert!(parse_quantity("90 m", Angle).is_err());
}

#[test]
fn numbers_for_people_have_a_prefix_and_four_digits() {
    for (value, unit, text) in [
        (25e-6, "m", "25 µm"),
        (1.33e12, "Pa", "1.33 TPa"),
        (0.2, "J/m^2", "200 mJ/m^2"),
        (0.0, "N", "0 N"),
        (-3.14159e-9, "N", "-3.142 nN"),
        (999.96, "m", "1 km"),
        (999.94, "m", "999.9 m"),
        (123456.0, "Pa", "123.5 kPa"),
        (1.0, "m", "1 m"),
        (0.001, "s", "1 ms"),
        (9.9999e-10, "m", "1 nm"),
        (1e-15, "m", "1 fm"),
        (1.5e-16, "m", "150 am"),
        (4.11e-21, "J", "4.11 zJ"),
        (1.5e-24, "m", "1.5e-24 m"),
        (2e15, "Pa", "2e15 Pa"),
        (6.25e-10, "m^2", "6.25e-10 m^2"),
        (0.25, "m^2", "0.25 m^2"),
        (298.15, "K", "298.1 K"),
        (0.1234567, "", "0.1235"),
        (1e-6, "", "1e-6"),
        (f64::INFINITY, "m", "inf m"),
    ] {
        assert_eq!(format_si(value, unit), text, "{value} {unit}");
    }
}

#[test]
fn formatted_values_can_be_parsed() {
    for exponent in -15..15 {
        let value = 1.234 * 10f64.powi(exponent);
        let text = format_si(value, "Pa");
        let back = parse_quantity(&text, Pressure).expect("own text");
        assert!((back / value - 1.0).abs() < 1e-12, "{value}: {text}");
    }
}
