/* The yardstick: Algorithm 2's right-hand side in the plane as one would write it by hand for one machine.
 *
 * Agents are copied in the order of their cells; pairs are a flat half list with a skin. A sweep goes over the list in
 * blocks: it gathers differences and keeps the pairs in range, evaluates force and adjacency in a loop without
 * branches, which the compiler vectorises, and scatters. Force and power are those of the library, to rounding.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 512 };

typedef struct { double x, y, vx, vy; } agent;
typedef struct { double r, eps, h, a, b, c, d_alpha, r_alpha; } pair_law;
typedef struct { double c1_alpha, c2_alpha, c1_gamma, c2_gamma; } gains;

typedef struct {
    long n, pairs, room;
    unsigned *first, *second, *order;
    agent *s;
    double *force;
} flock;

flock *flock_new(long n) {
    flock *f = calloc(1, sizeof *f);
    f->n = n;
    f->room = 16 * n + 1024;
    f->first = malloc(sizeof(unsigned) * f->room);
    f->second = malloc(sizeof(unsigned) * f->room);
    f->order = malloc(sizeof(unsigned) * n);
    f->s = aligned_alloc(64, (sizeof(agent) * n + 63) / 64 * 64);
    f->force = aligned_alloc(64, (2 * sizeof(double) * n + 63) / 64 * 64);
    return f;
}

void flock_free(flock *f) {
    free(f->first), free(f->second), free(f->order), free(f->s), free(f->force), free(f);
}

static void grow(flock *f, long needed) {
    f->room = 2 * f->room + needed;
    f->first = realloc(f->first, sizeof(unsigned) * f->room);
    f->second = realloc(f->second, sizeof(unsigned) * f->room);
}

/* Sort the agents by cell and list every pair closer than `reach`, once. */
long flock_build(flock *f, const double *q, const double *p, double reach) {
    long n = f->n, count = 0;
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY, r2 = reach * reach;
    for (long i = 0; i < n; i++) {
        low_x = fmin(low_x, q[2 * i]), high_x = fmax(high_x, q[2 * i]);
        low_y = fmin(low_y, q[2 * i + 1]), high_y = fmax(high_y, q[2 * i + 1]);
    }
    long across = (long)((high_x - low_x) / reach) + 3, rows = (long)((high_y - low_y) / reach) + 3;
    unsigned *start = calloc(across * rows + 2, sizeof *start), *cell = malloc(sizeof(unsigned) * n);
    for (long i = 0; i < n; i++) {
        long cx = (long)((q[2 * i] - low_x) / reach) + 1, cy = (long)((q[2 * i + 1] - low_y) / reach) + 1;
        cell[i] = cy * across + cx;
        start[cell[i] + 2]++;
    }
    for (long k = 1; k <= across * rows + 1; k++) start[k] += start[k - 1];
    for (long i = 0; i < n; i++) { /* leaves start[k] as the first agent of cell k */
        unsigned k = start[cell[i] + 1]++;
        f->order[k] = i;
        f->s[k] = (agent){q[2 * i], q[2 * i + 1], p[2 * i], p[2 * i + 1]};
    }
    for (long k = across; k < across * (rows - 1); k++) {
        unsigned begin = start[k], end = start[k + 1], east = start[k + 2];
        unsigned north = start[k + across - 1], north_end = start[k + across + 2];
        for (unsigned i = begin; i < end; i++) {
            long most = (east - i) + (north_end - north);
            if (count + most > f->room) grow(f, most);
            unsigned *first = f->first, *second = f->second;
            double x = f->s[i].x, y = f->s[i].y;
            for (unsigned j = i + 1; j < east; j++) {
                double dx = f->s[j].x - x, dy = f->s[j].y - y;
                first[count] = i, second[count] = j, count += dx * dx + dy * dy < r2;
            }
            for (unsigned j = north; j < north_end; j++) {
                double dx = f->s[j].x - x, dy = f->s[j].y - y;
                first[count] = i, second[count] = j, count += dx * dx + dy * dy < r2;
            }
        }
    }
    free(start), free(cell);
    return f->pairs = count;
}

/* sin on [-pi/2, pi/2] to rounding: its series, which ends there below 1e-16 */
static inline double sine(double y) {
    double z = y * y;
    return y * (1.0 + z * (-1.0 / 6 + z * (1.0 / 120 + z * (-1.0 / 5040 + z * (1.0 / 362880 + z * (-1.0 / 39916800
        + z * (1.0 / 6227020800.0 + z * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0
        - z / 121645100408832000.0)))))))));
}

static double sweep(const flock *f, const pair_law *law, const gains *g) {
    double dx[BLOCK], dy[BLOCK], s2[BLOCK], pull[BLOCK], rho[BLOCK], dissipation = 0.0;
    unsigned is[BLOCK], js[BLOCK];
    const unsigned *restrict first = f->first, *restrict second = f->second;
    const agent *restrict s = f->s;
    double *restrict u = f->force;
    const double r2 = law->r * law->r, eps = law->eps, h = law->h, taper = M_PI / (1.0 - h), scale = 1.0 / law->r_alpha;
    const double even = 0.5 * (law->a - law->b) * g->c1_alpha, odd = 0.5 * (law->a + law->b) * g->c1_alpha;
    const double centre = law->c - law->d_alpha, c2 = g->c2_alpha;
    for (long k0 = 0; k0 < f->pairs; k0 += BLOCK) {
        int size = f->pairs - k0 < BLOCK ? (int)(f->pairs - k0) : BLOCK, near = 0;
        for (int k = 0; k < size; k++) {
            unsigned i = first[k0 + k], j = second[k0 + k];
            double ex = s[j].x - s[i].x, ey = s[j].y - s[i].y, e2 = ex * ex + ey * ey;
            dx[near] = ex, dy[near] = ey, s2[near] = e2, is[near] = i, js[near] = j;
            near += e2 < r2;
        }
        for (int k = 0; k < near; k++) {
            double root = sqrt(1.0 + eps * s2[k]), z = s2[k] / (root + 1.0);
            double angle = taper * (z * scale - h);
            angle = (angle > 0.0 ? angle : 0.0) - 0.5 * M_PI;
            double share = 0.5 - 0.5 * sine(angle), w = z + centre, bent = sqrt(1.0 + w * w);
            rho[k] = share;
            pull[k] = share * (odd * w + even * bent) / (bent * root);
        }
        for (int k = 0; k < near; k++) {
            unsigned i = is[k], j = js[k];
            double vx = s[j].vx - s[i].vx, vy = s[j].vy - s[i].vy, drag = c2 * rho[k];
            double fx = pull[k] * dx[k] + drag * vx, fy = pull[k] * dy[k] + drag * vy;
            dissipation += rho[k] * (vx * vx + vy * vy);
            u[2 * i] += fx, u[2 * i + 1] += fy;
            u[2 * j] -= fx, u[2 * j + 1] -= fy;
        }
    }
    return dissipation;
}

/* The list is kept: new positions and velocities are gathered, the forces scattered to the caller's order. `target` is
 * (x, y, vx, vy) of the gamma-agent. Returns the power of the pair term and of the drag in the moving frame. */
double flock_flow(flock *f, const double *q, const double *p, const pair_law *law, const gains *g, const double *target,
                  double *u) {
    long n = f->n;
    double sum_x = 0.0, sum_y = 0.0, sum_2 = 0.0;
    for (long k = 0; k < n; k++) {
        unsigned i = f->order[k];
        agent a = {q[2 * i], q[2 * i + 1], p[2 * i], p[2 * i + 1]};
        f->s[k] = a;
        f->force[2 * k] = -g->c1_gamma * (a.x - target[0]) - g->c2_gamma * (a.vx - target[2]);
        f->force[2 * k + 1] = -g->c1_gamma * (a.y - target[1]) - g->c2_gamma * (a.vy - target[3]);
        sum_x += a.vx, sum_y += a.vy, sum_2 += a.vx * a.vx + a.vy * a.vy;
    }
    double dissipation = sweep(f, law, g);
    for (long k = 0; k < n; k++) {
        unsigned i = f->order[k];
        u[2 * i] = f->force[2 * k], u[2 * i + 1] = f->force[2 * k + 1];
    }
    return -g->c2_alpha * dissipation - g->c2_gamma * (sum_2 - (sum_x * sum_x + sum_y * sum_y) / n);
}

/* The same so many times, over a new list each time unless `reach` is 0: of a small flock, what a call from elsewhere
 * costs is as much as what it does. */
double flock_repeat(flock *f, const double *q, const double *p, const pair_law *law, const gains *g,
                    const double *target, double *u, long times, double reach) {
    double rate = 0.0;
    for (long k = 0; k < times; k++) {
        if (reach > 0.0) flock_build(f, q, p, reach);
        rate = flock_flow(f, q, p, law, g, target, u);
    }
    return rate;
}

/* A run of the classical Runge-Kutta method, with neither checks nor energies: the list is made anew where an agent has
 * moved by half the skin beside the mean. Agents are put in the order of their cells first and stay in it; q and p are
 * overwritten in the caller's. Returns how often the list was made. */
long flock_rk4(flock *f, double *q, double *p, const pair_law *law, const gains *g, const double *target, double reach,
               double dt, long steps) {
    long n = f->n, m = 2 * n, builds = 1;
    unsigned *caller = malloc(sizeof(unsigned) * n);
    double *work = malloc(8 * sizeof(double) * m), *x = work, *v = x + m, *u = v + m, *listed = u + m;
    double *y = listed + m, *yv = y + m, *sum = yv + m, *sv = sum + m;
    flock_build(f, q, p, reach);
    memcpy(caller, f->order, sizeof(unsigned) * n);
    for (long k = 0; k < n; k++)
        for (long c = 0; c < 2; c++) x[2 * k + c] = q[2 * caller[k] + c], v[2 * k + c] = p[2 * caller[k] + c];
    flock_build(f, x, v, reach);
    memcpy(listed, x, sizeof(double) * m);
    for (long step = 0; step < steps; step++) {
        memcpy(y, x, sizeof(double) * m), memcpy(yv, v, sizeof(double) * m);
        for (int stage = 0; stage < 4; stage++) {
            double mean_x = 0.0, mean_y = 0.0, farthest = 0.0, half = 0.5 * (reach - law->r);
            for (long k = 0; k < n; k++) mean_x += x[2 * k] - listed[2 * k], mean_y += x[2 * k + 1] - listed[2 * k + 1];
            mean_x /= n, mean_y /= n;
            for (long k = 0; k < n; k++) {
                double a = x[2 * k] - listed[2 * k] - mean_x, b = x[2 * k + 1] - listed[2 * k + 1] - mean_y;
                farthest = a * a + b * b > farthest ? a * a + b * b : farthest;
            }
            if (farthest > half * half) {
                flock_build(f, x, v, reach), builds++;
                memcpy(listed, x, sizeof(double) * m);
            }
            flock_flow(f, x, v, law, g, target, u);
            double weight = stage == 0 || stage == 3 ? 1.0 / 6.0 : 1.0 / 3.0, h = stage == 2 ? dt : 0.5 * dt;
            if (stage == 0)
                for (long k = 0; k < m; k++) sum[k] = weight * v[k], sv[k] = weight * u[k];
            else
                for (long k = 0; k < m; k++) sum[k] += weight * v[k], sv[k] += weight * u[k];
            if (stage < 3)
                for (long k = 0; k < m; k++) x[k] = y[k] + h * v[k], v[k] = yv[k] + h * u[k];
            else
                for (long k = 0; k < m; k++) x[k] = y[k] + dt * sum[k], v[k] = yv[k] + dt * sv[k];
        }
    }
    for (long k = 0; k < n; k++)
        for (long c = 0; c < 2; c++) q[2 * caller[k] + c] = x[2 * k + c], p[2 * caller[k] + c] = v[2 * k + c];
    free(caller), free(work);
    return builds;
}
