/* A worked example: the classical Runge-Kutta method in C99 as a program that can be judged.
 *
 *     cc -std=c99 -O2 -o rk4 rk4.c -lm
 *     taylor-verify run euler/generic --solver "process:./rk4 0.01"
 *
 * It reads a scene as JSON on stdin and writes a trajectory as JSON on stdout, and needs no library
 * but C's own. The argument is the longest step, in the scene's own time. rk4.py beside it is the same
 * program in Python; the keys are explained in cases/README.md of taylor-verify.
 *
 * No JSON reader is needed. Every number is an object of two lists, "text" and "hex". Every other key occurs
 * once in the document, and no value can look like one (inside a JSON string every quote is escaped). So
 * a value is found by searching for  "key":  then for  "hex":  and reading so many numbers in quotes,
 * which strtod understands. The keys read are
 *
 *     model             "euler" or "kirchhoff"
 *     columns           what the answer must hold (q0 and c1 among it where they are tracked)
 *     inverse_inertia   K (9)            moment    M (3)      angular_momentum   H (3)   (euler)
 *     rotor   the momentum of wheels (3), not part of H, where there are any
 *     linear coupling angular  A B C (9 each)   force couple  X L (3 each)               (kirchhoff)
 *     linear_impulse angular_impulse centre     x y c (3 each)                           (kirchhoff)
 *     damping           d (1), where there is any: -d H, or -d x and -d y, in the rates
 *     attitude          quaternion q (4), of any length, scalar first, body to space
 *     elapsed times     as many as there are samples
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fail(const char *what)
{
    fprintf(stderr, "rk4: %s\n", what);
    exit(EXIT_FAILURE);
}

static void *memory(void *old, size_t size)
{
    void *found = realloc(old, size);
    if (!found) fail("out of memory");
    return found;
}

/* Reading. */

static char *all_of_stdin(void)
{
    size_t room = 1 << 16, used = 0, got;
    char *text = memory(NULL, room);
    while ((got = fread(text + used, 1, room - used - 1, stdin)) > 0)
        if ((used += got) + 1 >= room) text = memory(text, room *= 2);
    text[used] = '\0';
    return text;
}

/* The place behind "key": */
static const char *find(const char *text, const char *key)
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, "\"%s\":", key);
    const char *place = strstr(text, wanted);
    if (!place) fail(key);
    return place + strlen(wanted);
}

/* The next number in quotes; *place is moved behind it. NULL at the end of the object. */
static const char *next_number(const char **place)
{
    const char *quote = *place + strcspn(*place, "\"}");
    if (*quote != '"') return NULL;
    const char *end = strchr(quote + 1, '"');
    if (!end) fail("the document ends inside a string");
    *place = end + 1;
    return quote + 1;
}

static void read_numbers(const char *scene, const char *key, double *numbers, int count)
{
    const char *place = find(find(scene, key), "hex");
    for (int i = 0; i < count; i++) {
        const char *number = next_number(&place);
        if (!number) fail(key);
        numbers[i] = strtod(number, NULL);
    }
}

static int count_numbers(const char *scene, const char *key)
{
    const char *place = find(find(scene, key), "hex");
    int count = 0;
    while (next_number(&place)) count++;
    return count;
}

/* Whether a JSON string is in the list or is the value behind a key, which ends at `stop`. */
static int has(const char *scene, const char *key, const char *word, char stop)
{
    const char *place = find(scene, key), *end = strchr(place, stop);
    char quoted[32];
    snprintf(quoted, sizeof quoted, "\"%s\"", word);
    const char *found = strstr(place, quoted);
    return found && end && found < end;
}

/* The equations. State: H, q (euler) or x, y, q, c (kirchhoff). */

static int is_euler;
static double K[9], M[3], wheels[3], A[9], B[9], B_transposed[9], C[9], X[3], L[3], damping;

static void apply(const double m[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* q' = q (0, omega) / 2 */
static void attitude_rate(const double q[4], const double w[3], double out[4])
{
    out[0] = (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2;
    out[1] = (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2;
    out[2] = (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2;
    out[3] = (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2;
}

/* v + 2 r x (r x v + q0 v), r = (q1, q2, q3): the vector in space axes. */
static void to_space(const double q[4], const double v[3], double out[3])
{
    double inner[3], turned[3];
    cross(q + 1, v, inner);
    for (int i = 0; i < 3; i++) inner[i] += q[0] * v[i];
    cross(q + 1, inner, turned);
    for (int i = 0; i < 3; i++) out[i] = v[i] + 2 * turned[i];
}

static void rates(const double *s, double *out)
{
    double w[3], U[3], a[3], b[3];
    if (is_euler) { /* H' = (H + wheels) x K H + M */
        apply(K, s, w);
        for (int i = 0; i < 3; i++) b[i] = s[i] + wheels[i];
        cross(b, w, a);
        for (int i = 0; i < 3; i++) out[i] = a[i] + M[i] - damping * s[i];
        attitude_rate(s + 3, w, out + 3);
        return;
    }
    const double *x = s, *y = s + 3, *q = s + 6;
    apply(A, x, a), apply(B, y, b);
    for (int i = 0; i < 3; i++) U[i] = a[i] + b[i];
    apply(B_transposed, x, a), apply(C, y, b);
    for (int i = 0; i < 3; i++) w[i] = a[i] + b[i];
    cross(x, w, a); /* x' = x x Omega + X */
    for (int i = 0; i < 3; i++) out[i] = a[i] + X[i] - damping * x[i];
    cross(y, w, a), cross(x, U, b); /* y' = y x Omega + x x U + L */
    for (int i = 0; i < 3; i++) out[3 + i] = a[i] + b[i] + L[i] - damping * y[i];
    attitude_rate(q, w, out + 6);
    to_space(q, U, out + 10); /* c' = R U */
}

enum { MOST = 13 };

static void step(double *s, int n, double h)
{
    double k1[MOST], k2[MOST], k3[MOST], k4[MOST], moved[MOST];
    rates(s, k1);
    for (int i = 0; i < n; i++) moved[i] = s[i] + h / 2 * k1[i];
    rates(moved, k2);
    for (int i = 0; i < n; i++) moved[i] = s[i] + h / 2 * k2[i];
    rates(moved, k3);
    for (int i = 0; i < n; i++) moved[i] = s[i] + h * k3[i];
    rates(moved, k4);
    for (int i = 0; i < n; i++) s[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

/* Writing. */

static void write_column(const char *name, const double *rows, int column, int width, int samples)
{
    printf(",\n\"%s\": [", name);
    for (int k = 0; k < samples; k++) printf("%s\"%a\"", k ? ", " : "", rows[k * width + column]);
    printf("]");
}

int main(int arguments, char **argument)
{
    static const char *const of_euler[] = {"w1", "w2", "w3", "q0", "q1", "q2", "q3"};
    static const char *const of_kirchhoff[] = {"x1", "x2", "x3", "y1", "y2", "y3", "q0",
                                               "q1", "q2", "q3", "c1", "c2", "c3"};
    double longest = arguments > 1 ? strtod(argument[1], NULL) : 0.01;
    double s[MOST] = {0}, *q, now = 0;
    long steps = 0;
    if (!(longest > 0)) fail("expected a positive step");

    char *scene = all_of_stdin();
    if (strstr(scene, "\"loads\":")) {
        printf("{\"unsuited\": \"rk4: expected constant loads, got some that the scene writes down\"}\n");
        return EXIT_SUCCESS;
    }
    is_euler = has(scene, "model", "euler", ',');
    if (is_euler) {
        read_numbers(scene, "inverse_inertia", K, 9);
        read_numbers(scene, "moment", M, 3);
        if (strstr(scene, "\"rotor\":")) read_numbers(scene, "rotor", wheels, 3);
        read_numbers(scene, "angular_momentum", s, 3);
        q = s + 3;
    } else {
        read_numbers(scene, "linear", A, 9);
        read_numbers(scene, "coupling", B, 9);
        read_numbers(scene, "angular", C, 9);
        read_numbers(scene, "force", X, 3);
        read_numbers(scene, "couple", L, 3);
        read_numbers(scene, "linear_impulse", s, 3);
        read_numbers(scene, "angular_impulse", s + 3, 3);
        read_numbers(scene, "centre", s + 10, 3);
        for (int i = 0; i < 9; i++) B_transposed[i] = B[3 * (i % 3) + i / 3];
        q = s + 6;
    }
    if (strstr(scene, "\"damping\":")) read_numbers(scene, "damping", &damping, 1);
    read_numbers(scene, "attitude", q, 4);
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) q[i] /= length;

    int samples = count_numbers(scene, "elapsed"), n = is_euler ? 7 : 13;
    double *elapsed = memory(NULL, (size_t)samples * sizeof *elapsed);
    double *times = memory(NULL, (size_t)samples * sizeof *times);
    double *rows = memory(NULL, (size_t)samples * (size_t)n * sizeof *rows);
    read_numbers(scene, "elapsed", elapsed, samples);
    read_numbers(scene, "times", times, samples);

    for (int k = 0; k < samples; k++) {
        /* Whole steps of equal length from sample to sample, so that none is interpolated. */
        double span = elapsed[k] - now;
        long count = (long)ceil(fabs(span) / longest);
        double h = count ? span / (double)count : 0;
        for (long i = 0; i < count; i++) step(s, n, h);
        steps += count, now = elapsed[k];
        memcpy(rows + k * n, s, (size_t)n * sizeof *s);
        if (is_euler) apply(K, s, rows + k * n);
    }

    printf("{\"steps\": %ld, \"evaluations\": %ld", steps, 4 * steps);
    write_column("t", times, 0, 1, samples);
    for (int i = 0; i < n; i++) {
        const char *name = is_euler ? of_euler[i] : of_kirchhoff[i];
        if (has(scene, "columns", name, ']')) write_column(name, rows, i, n, samples);
    }
    printf("}\n");
    free(rows), free(times), free(elapsed), free(scene);
    return ferror(stdout) || fflush(stdout) ? EXIT_FAILURE : EXIT_SUCCESS;
}
