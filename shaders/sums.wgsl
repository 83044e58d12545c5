// A sum while it is added up, and what of it passes between threads: the number as it is.
alias part = wide;

fn part_of(value: wide) -> part {
    return value;
}

fn add(sum: part, term: wide) -> part {
    return sum + term;
}

fn least(sum: part, term: wide) -> part {
    return select(sum, term, term < sum);
}

fn most(sum: part, term: wide) -> part {
    return select(sum, term, term > sum);
}

// What of it is compared.
fn leading(value: part) -> wide {
    return value;
}

fn part_value(value: part) -> wide {
    return value;
}

fn join_add(a: part, b: part) -> part {
    return a + b;
}
