"""Tooltips of the options of a relaxation: quality, methods, energies and metrics."""

_UNCHANGED = ("L²", "W^{1,2}", "W^{2,2}")
_VERTICES = "Punkte: so viele, wie die Abstände der Stränge brauchen"
_PENALISED = "auf der Energie mit Strafterm"
_PROJECTED = "mit projizierten gebrochenen Sobolev-Gradienten, Metrik J_C"

_QUALITIES = {
    "How near to the least energy the shape comes; sets some of the options in Expert": (
        "Wie nah die Form der kleinsten Energie kommt; setzt einige der Optionen unter Experten"
    ),
    "Options as they are set in Expert": "Optionen, wie sie unter Experten gesetzt sind",
    "Untangled and nearly at rest, to look at. Method: Sobolev L-BFGS, Tolerance: 0.01, Max Iterations: 300, "
    "Vertices: as many as the gaps between strands need": (
        "Entwirrt und fast in Ruhe, zum Ansehen. Methode: Sobolev L-BFGS, Toleranz: 0.01, Max. Iterationen: 300, "
        f"{_VERTICES}"
    ),
    "At rest as far as the eye can tell. Method: Sobolev L-BFGS, Tolerance: 0.0001, Max Iterations: 2000, "
    "Vertices: as many as the gaps between strands need": (
        "In Ruhe, soweit das Auge es sieht. Methode: Sobolev L-BFGS, Toleranz: 0.0001, Max. Iterationen: 2000, "
        f"{_VERTICES}"
    ),
    "The shape of least energy to many digits, in two or three times the time. Method: Sobolev Trust Region (Newton), "
    "Tolerance: 1e-08, Max Iterations: 2000, Vertices: as many as the gaps between strands need": (
        "Die Form kleinster Energie auf viele Stellen, in der zwei- bis dreifachen Zeit. "
        f"Methode: Sobolev-Vertrauensbereich (Newton), Toleranz: 1e-08, Max. Iterationen: 2000, {_VERTICES}"
    ),
}

_METHODS = {
    "Conjugate gradients (PR+) on the constraint manifold with projected fractional Sobolev gradients, metric J_C": (
        f"Konjugierte Gradienten (PR+) auf der Mannigfaltigkeit der Nebenbedingungen {_PROJECTED}"
    ),
    "Conjugate gradients (PR+) on the penalised energy": f"Konjugierte Gradienten (PR+) {_PENALISED}",
    "Explicit flow along projected fractional Sobolev gradients, metric J_C of Theorem 4.1, extrinsic W^{3/2,2}": (
        "Expliziter Fluss entlang projizierter gebrochener Sobolev-Gradienten, Metrik J_C aus Theorem 4.1, "
        "extrinsisches W^{3/2,2}"
    ),
    "L-BFGS on the constraint manifold with projected fractional Sobolev gradients, metric J_C": (
        f"L-BFGS auf der Mannigfaltigkeit der Nebenbedingungen {_PROJECTED}"
    ),
    "L-BFGS on the penalised energy": f"L-BFGS {_PENALISED}",
    "Nesterov's accelerated gradient on the penalised energy": f"Nesterovs beschleunigter Gradient {_PENALISED}",
    "Projected gradient flow, explicit, L²": "Projizierter Gradientenfluss, explizit, L²",
    "Projected gradient flow, explicit, W^{1,2}": "Projizierter Gradientenfluss, explizit, W^{1,2}",
    "Projected gradient flow, explicit, W^{2,2}": "Projizierter Gradientenfluss, explizit, W^{2,2}",
    "Projected gradient flow, explicit, W^{3/2,2}, intrinsic": (
        "Projizierter Gradientenfluss, explizit, W^{3/2,2}, intrinsisch"
    ),
    "Projected gradient flow, implicit, J_C of Theorem 4.1, extrinsic W^{3/2,2}": (
        "Projizierter Gradientenfluss, implizit, J_C aus Theorem 4.1, extrinsisches W^{3/2,2}"
    ),
    "Projected gradient flow, implicit, L²": "Projizierter Gradientenfluss, implizit, L²",
    "Projected gradient flow, implicit, W^{1,2}": "Projizierter Gradientenfluss, implizit, W^{1,2}",
    "Projected gradient flow, implicit, W^{2,2}": "Projizierter Gradientenfluss, implizit, W^{2,2}",
    "Projected gradient flow, implicit, W^{3/2,2}, intrinsic": (
        "Projizierter Gradientenfluss, implizit, W^{3/2,2}, intrinsisch"
    ),
    "Trust region in a subspace with Newton's direction, and projected fractional Sobolev gradients, metric J_C": (
        "Vertrauensbereich in einem Unterraum mit Newton-Richtung und projizierten gebrochenen Sobolev-Gradienten, "
        "Metrik J_C"
    ),
}

_OPTIONS = {
    "Edge energy of Kusner and Sullivan: 1/r² − 1/ϱ² at the edges' midpoints": (
        "Kantenenergie von Kusner und Sullivan: 1/r² − 1/ϱ² an den Mittelpunkten der Kanten"
    ),
    "Gauss points per edge of the metric J_C; work grows with their square; 0: the energy's own": (
        "Gauß-Punkte je Kante der Metrik J_C; der Aufwand wächst mit ihrem Quadrat; 0: die der Energie"
    ),
    "Go from a converged curve to the one of its Möbius images, all of the same energy, that bends least for its "
    "length, and relax that": (
        "Von einer konvergierten Kurve zu demjenigen ihrer Möbius-Bilder, alle von gleicher Energie, gehen, das sich "
        "für seine Länge am wenigsten biegt, und dieses entspannen"
    ),
    "How sums over all pairs of edges are made: dense, one by one; hierarchical, distant clusters as one, for many "
    "vertices; auto takes the faster one": (
        "Wie über alle Paare von Kanten summiert wird: dicht, eins nach dem anderen; hierarchisch, ferne Gruppen als "
        "eins, für viele Punkte; automatisch nimmt das Schnellere"
    ),
    "How the energy is minimised": "Wie die Energie minimiert wird",
    "Inner product that gradients are taken in": "Skalarprodukt, in dem Gradienten gebildet werden",
    "J_C of Theorem 4.1, extrinsic W^{3/2,2}": "J_C aus Theorem 4.1, extrinsisches W^{3/2,2}",
    "Largest error of the hierarchical solver, kept by checks against dense sums over sampled edges: of the projected "
    "gradient's norm, relative to it or to √E; a hundredth of it for the energy; the norm is that of the solver's own "
    "metric, some per cent from the dense solver's": (
        "Größter Fehler des hierarchischen Lösers, geprüft an dichten Summen über ausgewählte Kanten: der Norm des "
        "projizierten Gradienten, relativ zu ihr oder zu √E; ein Hundertstel davon für die Energie; die Norm ist die "
        "der Metrik des Lösers, einige Prozent neben der des dichten"
    ),
    "Möbius energy without arc distances, 2 Gauss points per edge": (
        "Möbius-Energie ohne Bogenabstände, 2 Gauß-Punkte je Kante"
    ),
    "Möbius energy without arc distances, 3 Gauss points per edge": (
        "Möbius-Energie ohne Bogenabstände, 3 Gauß-Punkte je Kante"
    ),
    "Möbius energy without arc distances, midpoint rule (Ishizeki–Nagasawa density)": (
        "Möbius-Energie ohne Bogenabstände, Mittelpunktregel (Dichte von Ishizeki–Nagasawa)"
    ),
    "Multiply all lengths by this: at once where nothing is in the way, otherwise step by step as obstacles and pins "
    "leave room, with edges split as strands draw near unless the mesh is fixed; below 1 the curve shrinks": (
        "Alle Längen damit malnehmen: auf einmal, wo nichts im Weg ist, sonst Schritt für Schritt, wie Hindernisse und "
        "feste Punkte Platz lassen; Kanten werden geteilt, wo Stränge sich nähern, außer auf festem Netz; unter 1 "
        "schrumpft die Kurve"
    ),
    "Number of tries to get on from a minimum, or from where the curve is stuck: a random motion, proved like all "
    "others, and a relaxation; those that end lower are kept, and the iterations of all count": (
        "Anzahl der Versuche, von einem Minimum weiterzukommen, oder von wo die Kurve festsitzt: eine zufällige "
        "Bewegung, bewiesen wie alle anderen, und eine Entspannung; was tiefer endet, wird behalten, und die "
        "Iterationen aller zählen"
    ),
    "Number of vertices to refine to, those of all components together; "
    "0: so many that neighbours are nearer than strands": (
        "Anzahl der Punkte, auf die verfeinert wird, die aller Komponenten zusammen; "
        "0: so viele, dass Nachbarn näher sind als Stränge"
    ),
    "Stop after this many seconds of computing, also in the middle of a step; the curve reached so far is kept; "
    "0: none": (
        "Nach so vielen Sekunden Rechnens beenden, auch mitten in einem Schritt; die erreichte Kurve bleibt erhalten; "
        "0: keine Grenze"
    ),
    "Stop after this many accepted steps and changes of mesh": (
        "Nach so vielen angenommenen Schritten und Netzänderungen beenden"
    ),
    "Stop when the projected gradient's metric norm is at most this times √E": (
        "Beenden, wenn die Norm des projizierten Gradienten höchstens dieses Vielfache von √E ist"
    ),
    "Tangent-point energy with exponents 3 and 6, at the edges' end points": (
        "Tangentenpunkt-Energie mit Exponenten 3 und 6, an den Endpunkten der Kanten"
    ),
    "Target lengths, equal within each component or kept as in the refined start; auto keeps them only among "
    "obstacles, and where they, or the gaps between edges, differ by more than 10:1: evening them out would press "
    "the curve against walls, or crumple it": (
        "Ziellängen, gleich in jeder Komponente oder wie im verfeinerten Anfang; automatisch behält sie nur zwischen "
        "Hindernissen und wo sie oder die Abstände zwischen Kanten um mehr als 10:1 verschieden sind: Angleichen würde "
        "die Kurve an Wände drücken oder zerknittern"
    ),
    "Tell whether a converged curve is a minimum, and go on downhill from a saddle": (
        "Sagen, ob eine konvergierte Kurve ein Minimum ist, und von einem Sattel weiter bergab gehen"
    ),
    "Tell whether a converged curve is a minimum: count the negative eigenvalues of the Lagrangian's Hessian": (
        "Sagen, ob eine konvergierte Kurve ein Minimum ist: die negativen Eigenwerte der Hesse-Matrix der "
        "Lagrange-Funktion zählen"
    ),
    "Vertex energy of Kusner and Sullivan: 1/r² − 1/ϱ² at the edges' tails": (
        "Punktenergie von Kusner und Sullivan: 1/r² − 1/ϱ² an den Anfangspunkten der Kanten"
    ),
    "W^{3/2,2}, intrinsic": "W^{3/2,2}, intrinsisch",
    "Weight of length errors in the penalty methods; 0: the method's own": (
        "Gewicht von Längenfehlern in den Strafmethoden; 0: das der Methode"
    ),
    "What is minimised, with a barrier between strands": "Was minimiert wird, mit einer Barriere zwischen Strängen",
    "Of random motions, of hops and of scrambled starts: equal numbers, equal motions": (
        "Der zufälligen Bewegungen, von Sprüngen und durchmischten Anfängen: gleiche Zahlen, gleiche Bewegungen"
    ),
    "the method's own": "die der Methode",
}

RELAXATION = {text: text for text in _UNCHANGED} | _QUALITIES | _METHODS | _OPTIONS
