// Sums of a thread, and what of them passes between threads: the numbers as they are.
alias part = wide;

fn add_sum(slot: u32, term: wide) {
    sums[slot] = sums[slot] + term;
}

fn least(slot: u32, term: wide) {
    if (term < sums[slot]) {
        sums[slot] = term;
    }
}

fn most(slot: u32, term: wide) {
    if (term > sums[slot]) {
        sums[slot] = term;
    }
}

fn part_of(slot: u32) -> part {
    return sums[slot];
}

fn set_part(slot: u32, value: part) {
    sums[slot] = value;
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
