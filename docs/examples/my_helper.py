from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices


class Helper:
    def reset(self, observation, goal, seed):
        self.me, self.goal = observation.agent, goal

    def act(self, observation, legal):
        world, home = observation.world, observation.world.home

        def do(action, *nodes):
            step = Step(action, tuple(ObjectRef(home.classes[i], 0, home.ids[i]) for i in nodes), self.me)
            return step if step in legal else None

        for literal, wanted in self.goal:
            if not isinstance(literal.target, int) or literal.subject == "agent:0":
                continue  # hers to do
            target, on = home.index[literal.target], literal.name == "ON"
            there = edge_rows.bears(world, target) if on else edge_rows.contents(world, target)
            every, mine = home.instances(literal.subject) & observation.mask, world.agents[self.me].held
            for i in indices(every & mine & ~there):
                put = do("PutBack" if on else "PutIn", i, target) or do("Open", target)
                return put or do("Walktowards", target) or do("Walktowards", home.direct_room[target])
            if (every & there).bit_count() < wanted:
                for i in indices(every & ~there & ~world.agents[0].held):
                    return do("Grab", i) or do("Walktowards", i)
        rooms = list(indices(home.rooms))
        return do("Walktowards", rooms[observation.tick // 20 % len(rooms)])
