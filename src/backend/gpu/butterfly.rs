//! Discrete Fourier transforms of 2, 3, 4, 5, 7 and 8 values, written out in WGSL.

use std::f64::consts::TAU;
use std::fmt::Write;

/// Sign of the exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// `exp(-2 pi i k m / n)`, without a factor.
    Forward,
    /// `exp(+2 pi i k m / n)`, without a factor.
    Inverse,
}

/// A number in WGSL with all the digits of a double: written short, small ones would lose them. It has
/// no type of its own, so single precision rounds it once.
pub fn literal(value: f64) -> String {
    format!("{value:e}")
}

/// The WGSL of `value` turned by a quarter in the direction of the transform's exponent.
fn quarter(direction: Direction, value: &str) -> String {
    match direction {
        Direction::Forward => format!("vec2<real>({value}.y, -{value}.x)"),
        Direction::Inverse => format!("vec2<real>(-{value}.y, {value}.x)"),
    }
}

/// Transforms the named variables in place.
pub fn butterfly(source: &mut String, direction: Direction, names: &[String]) {
    // Writing to a String cannot fail.
    let _ = source.write_str("{\n");
    match names.len() {
        1 => {}
        2 => two(source, names),
        4 => four(source, direction, names),
        8 => eight(source, direction, names),
        _ => odd(source, direction, names),
    }
    let _ = source.write_str("}\n");
}

fn two(source: &mut String, names: &[String]) {
    let (a, b) = (&names[0], &names[1]);
    let _ = writeln!(source, "let sum = {a} + {b};\n{b} = {a} - {b};\n{a} = sum;");
}

fn four(source: &mut String, direction: Direction, names: &[String]) {
    let [a, b, c, d] = [0, 1, 2, 3].map(|place| &names[place]);
    let turned = quarter(direction, "odd_difference");
    let _ = writeln!(
        source,
        "let even_sum = {a} + {c};\n\
         let even_difference = {a} - {c};\n\
         let odd_sum = {b} + {d};\n\
         let odd_difference = {b} - {d};\n\
         let turned = {turned};\n\
         {a} = even_sum + odd_sum;\n\
         {b} = even_difference + turned;\n\
         {c} = even_sum - odd_sum;\n\
         {d} = even_difference - turned;"
    );
}

/// Two transforms of four, over the even and the odd places, and a transform of two across them.
fn eight(source: &mut String, direction: Direction, names: &[String]) {
    let even: Vec<String> = names.iter().step_by(2).cloned().collect();
    let odd: Vec<String> = names.iter().skip(1).step_by(2).cloned().collect();
    for half in [&even, &odd] {
        let _ = source.write_str("{\n");
        four(source, direction, half);
        let _ = source.write_str("}\n");
    }
    let root = literal(0.5f64.sqrt());
    let sign = match direction {
        Direction::Forward => ["+", "-"],
        Direction::Inverse => ["-", "+"],
    };
    let [first, second, third] = [1, 2, 3].map(|place| &odd[place]);
    let _ = writeln!(
        source,
        "let first = {root} * vec2<real>({first}.x {plus} {first}.y, {first}.y {minus} {first}.x);\n\
         let second = {turned};\n\
         let third = {root} * vec2<real>({reverse}{third}.x {plus} {third}.y, {reverse}{third}.y {minus} {third}.x);",
        plus = sign[0],
        minus = sign[1],
        turned = quarter(direction, second),
        reverse = "-",
    );
    // The even part's values lie at places 0, 2, 4, 6 and the odd part's at 1, 3, 5, 7.
    for (place, odd_value) in [odd[0].as_str(), "first", "second", "third"]
        .iter()
        .enumerate()
    {
        let even_value = &even[place];
        let _ = writeln!(
            source,
            "let low_{place} = {even_value} + {odd_value};\nlet high_{place} = {even_value} - {odd_value};"
        );
    }
    for place in 0..4 {
        let _ = writeln!(
            source,
            "{} = low_{place};\n{} = high_{place};",
            names[place],
            names[place + 4]
        );
    }
}

/// An odd prime, by sums and differences of the values at opposite places.
fn odd(source: &mut String, direction: Direction, names: &[String]) {
    let radix = names.len();
    let half = radix / 2;
    let first = &names[0];
    for k in 1..=half {
        let (a, b) = (&names[k], &names[radix - k]);
        let _ = writeln!(
            source,
            "let sum_{k} = {a} + {b};\nlet difference_{k} = {a} - {b};"
        );
    }
    for m in 1..=half {
        let angle = |k: usize| TAU * ((k * m) % radix) as f64 / radix as f64;
        let cosines: Vec<String> = (1..=half)
            .map(|k| format!("{} * sum_{k}", literal(angle(k).cos())))
            .collect();
        let sines: Vec<String> = (1..=half)
            .map(|k| format!("{} * difference_{k}", literal(angle(k).sin())))
            .collect();
        let _ = writeln!(
            source,
            "let cosine_{m} = {first} + {};\nlet sine_{m} = {};\nlet turned_{m} = {};",
            cosines.join(" + "),
            sines.join(" + "),
            quarter(direction, &format!("sine_{m}")),
        );
    }
    let sums: Vec<String> = (1..=half).map(|k| format!("sum_{k}")).collect();
    let _ = writeln!(source, "{first} = {first} + {};", sums.join(" + "));
    for m in 1..=half {
        let _ = writeln!(
            source,
            "{} = cosine_{m} + turned_{m};\n{} = cosine_{m} - turned_{m};",
            names[m],
            names[radix - m]
        );
    }
}
