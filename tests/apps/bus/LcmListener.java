// A program with LCM's Java library, like lcm-spy: prints the name of each message that it receives on the bus of
// the URL given, and publishes on LIGHT/java, until it is ended.
import java.io.IOException;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

public class LcmListener implements LCMSubscriber {
  public static void main(String[] arguments) throws Exception {
    LCM lcm = new LCM(arguments[0]);
    lcm.subscribeAll(new LcmListener());
    for (;;) {
      lcm.publish("LIGHT/java", "on");
      Thread.sleep(50);
    }
  }

  public void messageReceived(LCM lcm, String channel, LCMDataInputStream message) {
    System.out.println(channel);
    System.out.flush();
  }
}
