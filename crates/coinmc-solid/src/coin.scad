
radius = diameter / 2;
half = thickness / 2;
taken = thickness * tan(abs(draft)); // of the narrower face's radius
heads_radius = draft < 0 ? radius - taken : radius;
tails_radius = draft > 0 ? radius - taken : radius;
edge_steps = 12;

// Radius and height along the edge of a face above, from face to side.
function upper_edge(radius) =
    edge == "rounded" ?
        [for (i = [0 : edge_steps]) let (angle = 90 * i / edge_steps)
            [radius - edge_size * (1 - sin(angle)), half - edge_size * (1 - cos(angle))]]
    : edge == "chamfered" ?
        [[radius - edge_size, half], [radius, half - edge_size]]
    :
        [[radius, half]];

module body() {
    upper = upper_edge(heads_radius);
    below = upper_edge(tails_radius);
    lower = [for (i = [len(below) - 1 : -1 : 0]) [below[i][0], -below[i][1]]];
    rotate_extrude()
        polygon(concat([[0, half]], upper, lower, [[0, -half]]));
}

// n recesses around the height z of a face; half of each is in the air.
module recesses(n, z) {
    for (i = [0 : n - 1])
        rotate([0, 0, 360 * i / n])
            translate([0, 0, z])
                rotate_extrude(angle = 180 / n)
                    translate([mark_inner, -mark_depth])
                        square([mark_outer - mark_inner, 2 * mark_depth]);
}

difference() {
    body();
    if (marks) {
        recesses(heads, half);
        recesses(tails, -half);
    }
}
