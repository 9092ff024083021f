// A free rigid body by Kutta's method in f64, the step halved until the exact motion is met.
//     ./example euler-generic.csv 1 2 3 1e-10
// The principal moments are those of "body" in euler-generic.json; the first row is the start.
use std::{env, fs, process::exit};

type Vector = [f64; 3];

struct Row {
    t: f64,
    omega: Vector,
    radius: f64,
}

fn read(path: &str) -> Vec<Row> {
    let text = fs::read_to_string(path).expect("a file that can be read");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a heading line").split(',').collect();
    let place = |name| {
        names
            .iter()
            .position(|n| *n == name)
            .expect("the columns of a free body")
    };
    let [t, w1, w2, w3, radius] = ["t", "w1", "w2", "w3", "radius"].map(place);
    lines
        .map(|line| {
            // 32 digits are read, and rounded once to the nearest double.
            let cells: Vec<f64> = line
                .split(',')
                .map(|c| c.parse().expect("a number"))
                .collect();
            Row {
                t: cells[t],
                omega: [cells[w1], cells[w2], cells[w3]],
                radius: cells[radius],
            }
        })
        .collect()
}

// Euler's equations: I omega' = (I omega) x omega.
fn rate(moments: &Vector, w: &Vector) -> Vector {
    let [a, b, c] = moments;
    [
        (b - c) / a * w[1] * w[2],
        (c - a) / b * w[2] * w[0],
        (a - b) / c * w[0] * w[1],
    ]
}

fn moved(w: &Vector, k: &Vector, h: f64) -> Vector {
    [0, 1, 2].map(|i| w[i] + h * k[i])
}

fn step(moments: &Vector, w: &Vector, h: f64) -> Vector {
    let k1 = rate(moments, w);
    let k2 = rate(moments, &moved(w, &k1, h / 2.0));
    let k3 = rate(moments, &moved(w, &k2, h / 2.0));
    let k4 = rate(moments, &moved(w, &k3, h));
    [0, 1, 2].map(|i| w[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

fn length(v: &Vector) -> f64 {
    v.iter().map(|part| part * part).sum::<f64>().sqrt()
}

// The largest error over the largest |omega|, with so many steps from row to row.
fn error(rows: &[Row], moments: &Vector, steps: u32) -> f64 {
    let size = rows
        .iter()
        .map(|row| length(&row.omega))
        .fold(0.0, f64::max);
    let (mut w, mut worst) = (rows[0].omega, 0.0);
    for pair in rows.windows(2) {
        for _ in 0..steps {
            w = step(moments, &w, (pair[1].t - pair[0].t) / f64::from(steps));
        }
        let off = length(&moved(&w, &pair[1].omega, -1.0)) / size;
        // f64::max would drop a NaN.
        if !(off <= worst) {
            worst = off;
        }
    }
    worst
}

fn main() {
    let words: Vec<String> = env::args().collect();
    if words.len() != 6 {
        eprintln!("usage: example REFERENCE I1 I2 I3 TOLERANCE");
        exit(2);
    }
    let rows = read(&words[1]);
    let [a, b, c, tolerance] = [2, 3, 4, 5].map(|i: usize| words[i].parse().expect("a number"));
    let radius = rows.iter().map(|row| row.radius).fold(0.0, f64::max);
    println!("the reference is known to {radius:.1e}");
    let mut before = 0.0;
    for steps in [25, 50, 100, 200, 400, 800, 1600] {
        let error = error(&rows, &[a, b, c], steps);
        // The method is of order four: a sixteenth, until only roundings are left.
        let gained = if before > 0.0 {
            format!(", 1/{:.1} of it", before / error)
        } else {
            String::new()
        };
        println!("{steps:>5} steps a row: error {error:.2e}{gained}");
        if error <= tolerance {
            return;
        }
        before = error;
    }
    exit(1);
}
