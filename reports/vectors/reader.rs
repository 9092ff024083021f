// Compares a solver with the right answers: rustc -O reader.rs && ./reader vectors.json 1e-9
// Put your own simulator in place of `solve`; this one knows free bodies, wheels, constant moments.
use std::{env, fs, process::exit};
type Vector = [f64; 3];
const KINDS: [&str; 3] = ["\"kind\":\"free\"", "\"kind\":\"wheels\"", "\"kind\":\"moment\""];
// A question is a line; the numbers of a name are the first list after it.
fn numbers(line: &str, name: &str) -> Vec<f64> {
    let (_, list) = line.split_once(&format!("\"{name}\":")).expect(name);
    let list = list.split("],\"").next().expect(name);
    list.split('"').filter_map(|word| word.parse().ok()).collect()
}
fn cross(a: &[f64], b: &[f64]) -> Vector {
    [1, 2, 0].map(|i: usize| a[i] * b[(i + 1) % 3] - a[(i + 1) % 3] * b[i])
}
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
fn moved(a: &[f64], b: &[f64], h: f64) -> Vector {
    [0, 1, 2].map(|i| a[i] + h * b[i])
}
fn solve(line: &str) -> Vec<Vector> {
    let [inertia, times, moment, rotor, start] =
        ["inertia", "times", "moment", "rotor", "omega"].map(|name| numbers(line, name));
    let rows = [0, 3, 6].map(|i| moved(&inertia[i..], &[0.0; 3], 0.0));
    let inverse = [(1, 2), (2, 0), (0, 1)].map(|(i, k)| cross(&rows[i], &rows[k]));
    let rate = |w: &Vector| {
        let momentum = moved(&[0, 1, 2].map(|i: usize| dot(&rows[i], w)), &rotor, 1.0);
        let total = moved(&cross(&momentum, w), &moment, 1.0);
        [0, 1, 2].map(|i: usize| dot(&inverse[i], &total) / dot(&rows[0], &inverse[0]))
    };
    let mut motion = vec![moved(&start, &[0.0; 3], 0.0)];
    for pair in times.windows(2) {
        let (mut w, h) = (motion[motion.len() - 1], (pair[1] - pair[0]) / 200.0);
        for _ in 0..200 {
            let p = rate(&w);
            let q = rate(&moved(&w, &p, h / 2.0));
            let r = rate(&moved(&w, &q, h / 2.0));
            let s = rate(&moved(&w, &r, h));
            w = [0, 1, 2].map(|i| w[i] + h / 6.0 * (p[i] + 2.0 * q[i] + 2.0 * r[i] + s[i]));
        }
        motion.push(w);
    }
    motion
}
fn is_right(line: &str, tolerance: f64) -> bool {
    solve(line).iter().enumerate().all(|(k, w)| {
        let truth = ["w1", "w2", "w3"].map(|name| numbers(line, name)[k]);
        let left = moved(w, &truth, -1.0);
        dot(&left, &left).sqrt() <= tolerance * dot(&truth, &truth).sqrt()
    })
}
fn main() {
    let words: Vec<String> = env::args().collect();
    let text = fs::read_to_string(&words[1]).expect("vectors.json");
    let tolerance = words[2].parse().expect("a tolerance");
    let asked = text.lines().filter(|line| KINDS.iter().any(|kind| line.contains(kind)));
    let (right, wrong): (Vec<_>, Vec<_>) = asked.partition(|line| is_right(line, tolerance));
    println!("{} right, {} wrong", right.len(), wrong.len());
    exit(i32::from(right.is_empty() || !wrong.is_empty()));
}
