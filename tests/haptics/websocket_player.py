# Stands for the bHaptics Player: a WebSocket server of an independent library. Prints each message as a line. Argument: a port.
import asyncio
import sys

import websockets


async def hear(socket, *_):
    print("connected", flush=True)
    async for message in socket:
        print(message, flush=True)


async def main():
    async with websockets.serve(hear, "127.0.0.1", int(sys.argv[1])):
        print("ready", flush=True)
        await asyncio.sleep(120)


asyncio.run(main())
